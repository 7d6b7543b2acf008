#pragma once

#include "host/bench/embree_kernel.hpp"
#include "host/kernel/direct_sampling.hpp"
#include "host/render/settings.hpp"
#include "scene/model/scene.hpp"

#include <vector>

namespace stromboli::bench {

/// What an EmbreeWorld samples light from: the kernel's own tables (host/kernel/light_table.hpp),
/// decoded.
struct EmbreeLights {
    std::vector<native::Light> lights;
    std::vector<native::TriangleLight> triangles;
    std::vector<native::LightEntry> entries;
    std::vector<native::AliasColumn> columns;
    std::vector<native::LightNode> nodes;
    uint32_t choice = 0, areaLights = 0;
    std::array<uint32_t, gpu::LIGHT_GROUP_COUNT> lightsInGroup{};
    DirectSampling direct;
    bool oneQuad = false, hasAmbient = false;
    bool onlyNearWithoutCones = false; ///< native::World::onlyNearWithoutCones
    float ambientOfBounces = 0;        ///< native::World::ambientOfBounces
};

EmbreeLights embreeLights(const Scene& scene, const RenderSettings& settings);

inline native::Vec3 plain(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

} // namespace stromboli::bench
