#include "host/film/film.hpp"

#include <limits>

namespace stromboli {

/// Written as ordered comparisons, which NaN fails.
static bool isRadiance(double value) {
    return value >= 0 && value <= std::numeric_limits<double>::max();
}

glm::dvec3 PixelStatistics::variance() const {
    if (count < 2) return glm::dvec3(0.0);
    return m2 / double(count - 1);
}

glm::dvec3 PixelStatistics::varianceOfMean() const {
    if (count < 2) return glm::dvec3(0.0);
    return variance() / double(count);
}

void PixelStatistics::add(const glm::dvec3& radiance, double weight) {
    if (!isRadiance(radiance.x) || !isRadiance(radiance.y) || !isRadiance(radiance.z)) {
        if (rejected == 0) firstRejected = taken();
        ++rejected;
        return;
    }
    ++count;
    const glm::dvec3 value = weight * radiance;
    const glm::dvec3 delta = value - mean;
    mean += delta / double(count);
    m2 += delta * (value - mean);
}

void PixelStatistics::merge(const PixelStatistics& other) {
    if (rejected == 0 && other.rejected > 0) firstRejected = taken() + other.firstRejected;
    rejected += other.rejected;
    if (other.count == 0) return;

    const double here = count, there = other.count, both = here + there;
    const glm::dvec3 delta = other.mean - mean;
    mean += delta * (there / both);
    m2 += other.m2 + delta * delta * (here * there / both);
    count += other.count;
}

} // namespace stromboli
