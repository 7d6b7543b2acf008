#pragma once

#include "host/kernel/gpu_scene.hpp"

#include <vector>

namespace stromboli::test {

/// A primitive as it lies in a leaf of the tree.
struct Placed {
    uint32_t place = 0; ///< 2 * record + slot
    bool isSphere = false;
    glm::vec3 v0{0.0f}, v1{0.0f}, v2{0.0f}; ///< corners; v0: the centre of a sphere
    float radius = 0;
};

/// The scene as the renderer packs it; it need not have materials.
GpuScene pack(Scene scene);

/// By scene primitive: triangles, then spheres.
std::vector<Placed> placed(const GpuScene& scene);

} // namespace stromboli::test
