#pragma once

#include <glm/glm.hpp>

#include <cstddef>

namespace stromboli {

/// A rectangle through which a room sees the sky, a window as a rule: light samples to the sky aim
/// at it (docs/theory/estimator.md, "Portals"). It is no surface, no ray meets it.
struct Portal {
    glm::vec3 corner{0};
    glm::vec3 edgeA{0}, edgeB{0}; ///< at right angles, from the corner
};

/// More are not used: each light sample looks at all of them.
inline constexpr size_t kMostPortals = 8;

} // namespace stromboli
