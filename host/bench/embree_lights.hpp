#pragma once

#include "host/bench/embree_kernel.hpp"
#include "host/render/settings.hpp"
#include "scene/model/scene.hpp"

#include <vector>

namespace stromboli::bench {

/// What an EmbreeWorld samples light from, in the kernel's order.
struct EmbreeLights {
    std::vector<native::Light> lights; ///< area lights first
    std::vector<native::LampTriangle> triangles;
    std::vector<native::LampColumn> columns;
    std::vector<native::LightNode> nodes;
    native::LightChoice choice = native::LightChoice::Area;
    uint32_t areaLights = 0;
};

EmbreeLights embreeLights(const Scene& scene, LightChoice choice);

inline native::Vec3 plain(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

} // namespace stromboli::bench
