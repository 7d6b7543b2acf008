#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <vector>

namespace stromboli::bvh {

/// Some of a scene's triangles as a scene of their own, with the positions that they use and
/// nothing else.
struct ScenePart {
    Scene scene;
    std::vector<uint32_t> primitiveOf; ///< by primitive of the part: its number in the whole scene
};

/// Triangles from `first` on, up to `end`.
ScenePart partOf(const Scene& scene, uint32_t first, uint32_t end);

/// `triangles`: numbers of those in the part, in ascending order.
ScenePart partOf(const Scene& scene, std::vector<uint32_t> triangles);

/// Whether a tree over one part is one over the other: as many triangles with the same corners,
/// bit for bit.
bool haveSameShape(const Scene& a, const Scene& b);

} // namespace stromboli::bvh
