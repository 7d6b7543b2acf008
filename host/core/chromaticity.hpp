#pragma once

#include <glm/glm.hpp>

namespace stromboli {

/// Where a colour lies in the chromaticity diagram of CIE 1931.
struct Chromaticity {
    double x = 0, y = 0;
};

/// The white of Rec. 709 and sRGB.
inline constexpr Chromaticity kD65{0.3127, 0.3290};

/// A colour of luminance Y = 1; y must not be 0.
inline glm::dvec3 xyzOf(const Chromaticity& c) {
    return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

/// The primaries of a colour space.
struct Primaries {
    Chromaticity red, green, blue, white;
};
inline constexpr Primaries kRec709{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, kD65};
/// ITU-R BT.2020.
inline constexpr Primaries kRec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65};

/// XYZ of linear red, green and blue, of which (1, 1, 1) is white of luminance 1.
inline glm::dmat3 xyzFromRgb(const Primaries& p) {
    const glm::dmat3 columns(xyzOf(p.red), xyzOf(p.green), xyzOf(p.blue));
    const glm::dvec3 scale = glm::inverse(columns) * xyzOf(p.white);
    return {columns[0] * scale.x, columns[1] * scale.y, columns[2] * scale.z};
}

/// From XYZ under one white to XYZ under another, to which the cones adapt: what is `from` becomes
/// `to` (Lam 1985, "Bradford").
inline glm::dmat3 chromaticAdaptation(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dmat3 cones = glm::transpose(
        glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
    const glm::dvec3 factors = cones * to / (cones * from);
    glm::dmat3 scale(1);
    for (int i = 0; i < 3; ++i)
        scale[i][i] = factors[i];
    return glm::inverse(cones) * scale * cones;
}

} // namespace stromboli
