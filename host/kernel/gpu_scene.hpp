#pragma once

#include "host/bvh/wide_layout.hpp"
#include "scene/model/emitters.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <vector>

namespace stromboli {

/// The scene in the arrays that the kernel reads, ready to upload.
struct GpuScene {
    WideLayout bvh;
    std::vector<gpu::Primitive> primitives; ///< in the order of the tree's leaves
    std::vector<gpu::Material> materials;
    std::vector<gpu::Light> lights; ///< area lights first
    std::vector<gpu::EmitterEntry> emitterEntries;
    uint32_t areaLights = 0;
    uint32_t deltaLights = 0;
    bool hasTriangles = false, hasSpheres = false;
    bool hasNormals = false; ///< any triangle with shading normals
};

/// Packs the scene, whose hierarchy is `bvh`. With cs184, lights are those of scene.lights;
/// emissive geometry is not sampled (docs/estimator.md, "CS184 mode").
GpuScene packScene(const Scene& scene, WideLayout bvh, bool cs184);

/// Octahedral encoding of a unit vector (Meyer et al. 2010), two 16-bit signed fractions.
uint32_t encodeNormal(const glm::vec3& n);

} // namespace stromboli
