#include "host/stress/totals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::stress {
namespace {

double sigmas(const glm::dvec3& difference, const glm::dvec3& expected, const glm::dvec3& error) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        const double excess = std::abs(difference[c]) - kRounding * std::abs(expected[c]);
        if (excess <= 0) continue;
        if (!(error[c] > 0)) return std::numeric_limits<double>::infinity(); // NaN, too
        worst = std::max(worst, excess / error[c]);
    }
    return worst;
}

} // namespace

Totals::Totals(const Film& film) {
    for (const PixelStatistics& p : film.pixels)
        all.merge(p);
}

PixelStatistics columnOf(const Film& film, uint32_t x) {
    PixelStatistics all;
    for (uint32_t y = 0; y < film.height; ++y)
        all.merge(film.at(x, y));
    return all;
}

double Totals::sum() const {
    return std::max({all.mean.x, all.mean.y, all.mean.z}) * all.count;
}

double sigmasOff(const Totals& found, const glm::dvec3& expected) {
    return sigmas(found.all.mean - expected, expected, found.error());
}

double sigmasOff(const Totals& found, const Totals& other) {
    const glm::dvec3 a = found.error(), b = other.error();
    return sigmas(found.all.mean - other.all.mean, other.all.mean, glm::sqrt(a * a + b * b));
}

} // namespace stromboli::stress
