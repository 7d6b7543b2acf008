#include "host/compare/flip_color.hpp"

#include <cmath>

namespace stromboli::compare {
namespace {

/// IEC 61966-2-1's primaries and white point D65, (x, y) = (0.3127, 0.3290), as exact fractions:
/// XYZ of linear RGB. Column by column, as GLM stores it.
const glm::dmat3 kXyzFromRgb = {10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382,
                                8788810.0 / 24577794,  8788810.0 / 12288897, 8788810.0 / 73733382,
                                4435075.0 / 24577794,  887015.0 / 12288897,  70074185.0 / 73733382};
const glm::dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const glm::dvec3 kWhite = kXyzFromRgb * glm::dvec3(1);

double labCurve(double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

} // namespace

glm::dvec3 yccFromLinear(const glm::dvec3& rgb) {
    const glm::dvec3 t = kXyzFromRgb * rgb / kWhite;
    return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}

glm::dvec3 linearFromYcc(const glm::dvec3& ycc) {
    const double y = (ycc.x + 16) / 116;
    const glm::dvec3 t = {y + ycc.y / 500, y, y - ycc.z / 200};
    return kRgbFromXyz * (t * kWhite);
}

glm::dvec3 huntLabFromLinear(const glm::dvec3& rgb) {
    const glm::dvec3 t = kXyzFromRgb * rgb / kWhite;
    const double fy = labCurve(t.y), lightness = 116 * fy - 16;
    return {lightness, 0.01 * lightness * 500 * (labCurve(t.x) - fy),
            0.01 * lightness * 200 * (fy - labCurve(t.z))};
}

double hyAb(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = a - b;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

} // namespace stromboli::compare
