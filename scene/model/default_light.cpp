#include "scene/model/default_light.hpp"

#include "scene/model/mean_emission.hpp"
#include "scene/model/surface_lookup.hpp"

#include <algorithm>

namespace stromboli {

/// The mean radiance of all surfaces, of which the default light would be 1, below which the
/// emission is an ornament.
static constexpr double kLeastRadiance = 0.05;

bool hasSomethingToDraw(const Scene& scene) {
    if (scene.placedTriangles() > 0 || !scene.spheres.empty()) return true;
    if (scene.surrounding != kNoMedium) return true;
    return scene.environment && scene.environment->strength > 0 &&
           std::ranges::any_of(scene.environment->radiance,
                               [](const glm::vec3& radiance) { return radiance != glm::vec3(0); });
}

bool shines(const Scene& scene) {
    const auto emits = [&](const auto& shape) { return scene.materials[shape.material].emits(); };
    if (scene.environment) return true;
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const Light& light) { return light.color != glm::vec3(0); }) ||
           std::any_of(scene.triangles.begin(), scene.triangles.end(), emits) ||
           std::any_of(scene.spheres.begin(), scene.spheres.end(), emits);
}

bool lightsItsSurfaces(const Scene& scene) {
    if (!shines(scene)) return false;
    const auto emits = [&](const auto& shape) {
        const Material& m = scene.materials[shape.material];
        return m.emits() && !textureIn(m, TextureSlot::Emission);
    };
    const bool hasPlainLight =
        scene.environment ||
        std::any_of(scene.lights.begin(), scene.lights.end(),
                    [](const Light& light) { return light.color != glm::vec3(0); }) ||
        std::any_of(scene.triangles.begin(), scene.triangles.end(), emits) ||
        std::any_of(scene.spheres.begin(), scene.spheres.end(), emits);
    if (hasPlainLight || !scene.spheres.empty()) return true;
    const MeanEmission emission(scene);
    double power = 0, area = 0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                         c = scene.positions[t.corner[2]];
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
        if (scene.materials[t.material].emits()) power += emission.powerOfTriangle(i);
    }
    return power >= kLeastRadiance * area;
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
