#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/render/settings.hpp"
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
    LightChoice lightChoice = LightChoice::Tree; ///< of many emissive triangles ...
    bool manyLampTriangles = false;              ///< ... which are lights[0] then
    uint32_t lightTreeLevels = 0;
    float lampGap = 0; ///< lamp_gap.hpp
    bool hasTriangles = false, hasSpheres = false;
    bool hasNormals = false; ///< any triangle with shading normals
};

/// Packs the scene, whose hierarchy is `bvh`. With cs184, lights are those of scene.lights;
/// emissive geometry is not sampled (docs/estimator.md, "CS184 mode").
GpuScene packScene(const Scene& scene, WideLayout bvh, bool cs184,
                   LightChoice choice = LightChoice::Tree);

/// Number of the primitive's material.
inline uint32_t materialOf(const gpu::Primitive& p) {
    return p.material & ~gpu::PRIMITIVE_IS_SMOOTH;
}

/// Octahedral encoding of a unit vector (Meyer et al. 2010), two 16-bit signed fractions.
uint32_t encodeNormal(const glm::vec3& n);
/// The unit vector of a code, as the shaders decode it but for rounding.
glm::vec3 decodeNormal(uint32_t code);

} // namespace stromboli
