#include "host/reference/environment.hpp"

#include "host/core/color.hpp"
#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// Counter-clockwise about +y, seen from above.
glm::dvec3 rotate(const glm::dvec3& v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

struct Picked {
    size_t index;
    double rest; ///< uniform in [0, 1)
};

/// sums: running sums of weights.
Picked pick(const double* sums, size_t count, double u) {
    const double target = u * sums[count - 1];
    const size_t index =
        std::min(size_t(std::upper_bound(sums, sums + count, target) - sums), count - 1);
    const double before = index == 0 ? 0 : sums[index - 1];
    return {index, std::clamp((target - before) / (sums[index] - before), 0.0, 1.0)};
}

} // namespace

EnvironmentMap::EnvironmentMap(const Environment& environment) : environment_(environment) {
    const int64_t width = environment.width, height = environment.height;
    double sum = 0;
    for (int64_t y = 0; y < height; ++y) {
        const double solidAngle = 2 * kPi / double(width) *
                                  (std::cos(kPi * double(y) / double(height)) -
                                   std::cos(kPi * double(y + 1) / double(height)));
        double inRow = 0;
        for (int64_t x = 0; x < width; ++x)
            sumsInRow_.push_back(inRow += neighbourhoodLuminance(x, y) * solidAngle);
        rowSums_.push_back(sum += inRow);
    }
}

glm::dvec3 EnvironmentMap::texel(int64_t x, int64_t y) const {
    const int64_t width = environment_.width, height = environment_.height;
    const int64_t row = std::clamp<int64_t>(y, 0, height - 1), column = (x + width) % width;
    return environment_.radiance[size_t(row * width + column)];
}

double EnvironmentMap::neighbourhoodLuminance(int64_t x, int64_t y) const {
    double most = 0;
    for (int64_t dy = -1; dy <= 1; ++dy)
        for (int64_t dx = -1; dx <= 1; ++dx)
            most = std::max(most, luminance(texel(x + dx, y + dy)));
    return most;
}

glm::dvec3 EnvironmentMap::radiance(const glm::dvec3& direction) const {
    const glm::dvec3 d = rotate(direction, -double(environment_.rotation));
    const double u = std::atan2(d.x, -d.z) / (2 * kPi) + 0.5;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi;
    const double x = u * environment_.width - 0.5, y = v * environment_.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto column = int64_t(left), row = int64_t(top);
    const glm::dvec3 above = glm::mix(texel(column, row), texel(column + 1, row), x - left);
    const glm::dvec3 below = glm::mix(texel(column, row + 1), texel(column + 1, row + 1), x - left);
    return double(environment_.strength) * glm::mix(above, below, y - top);
}

EnvironmentMap::Sample EnvironmentMap::sample(const glm::dvec3& u) const {
    const size_t width = environment_.width, height = environment_.height;
    Sample s;
    if (!(rowSums_.back() > 0)) return s;
    const Picked row = pick(rowSums_.data(), height, u.x);
    const double* const sums = sumsInRow_.data() + row.index * width;
    const Picked column = pick(sums, width, u.y);
    // Uniform by solid angle in the texel: in the azimuth and in the height y.
    const double top = std::cos(kPi * double(row.index) / double(height));
    const double bottom = std::cos(kPi * double(row.index + 1) / double(height));
    const double y = glm::mix(top, bottom, u.z);
    const double azimuth =
        2 * kPi * ((double(column.index) + column.rest) / double(width) - 0.5); // from -z
    const double sine = std::sqrt(std::max(1 - y * y, 0.0));
    s.direction = rotate({sine * std::sin(azimuth), y, -sine * std::cos(azimuth)},
                         double(environment_.rotation));
    const double before = column.index == 0 ? 0 : sums[column.index - 1];
    const double probability = (sums[column.index] - before) / rowSums_.back();
    const double solidAngle = 2 * kPi / double(width) * (top - bottom);
    s.weight = radiance(s.direction) * (solidAngle / probability);
    return s;
}

} // namespace stromboli::reference
