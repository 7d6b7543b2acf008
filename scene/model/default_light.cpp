#include "scene/model/default_light.hpp"

#include <algorithm>

namespace stromboli {

bool shines(const Scene& scene) {
    const auto emits = [&](const auto& shape) { return scene.materials[shape.material].emits(); };
    if (scene.environment) return true;
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const Light& light) { return light.color != glm::vec3(0); }) ||
           std::any_of(scene.triangles.begin(), scene.triangles.end(), emits) ||
           std::any_of(scene.spheres.begin(), scene.spheres.end(), emits);
}

Light defaultLight() {
    Light sky;
    sky.name = "default light";
    sky.kind = LightKind::Ambient;
    sky.color = glm::vec3(1);
    sky.upperHemisphereOnly = true;
    return sky;
}

} // namespace stromboli
