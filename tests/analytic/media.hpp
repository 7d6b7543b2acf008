#pragma once

#include "tests/analytic/scenes.hpp"

#include <cmath>

namespace stromboli::test {

inline glm::dvec3 exponential(const glm::dvec3& depth) {
    return {std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z)};
}

inline constexpr float kThickness = 0.75f;

/// A slab of a medium, as wide as if it had no end, from z = 0.25 up to 1, over the floor z = 0,
/// which shines with the radiance 1 and reflects nothing.
inline SceneMaker slab(const Medium& m) {
    SceneMaker b;
    b.quad({-80, -80, 0}, {160, 0, 0}, {0, 160, 0}, b.add(emissive(1)));
    b.box({-80, -80, 0.25f}, {80, 80, 0.25f + kThickness}, b.add(border(b.add(m))));
    return b;
}

/// The length in the slab of the ray that kAbove sees.
inline double lengthInSlab() {
    return kThickness / std::abs(kAbove.back.z);
}

} // namespace stromboli::test
