#include "scene/model/area_lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace stromboli {
namespace {

/// True where every corner of the triangle lies within a hundredth of the light's own size of its
/// plane and the triangle's centre lies over the rectangle. The hundredth is a matter of modelling
/// (how far apart an author may put an emitter and its light), not of rounding.
bool standsFor(const Scene& scene, const Triangle& t, const Light& light) {
    const glm::dvec3 ex = light.edgeX, ey = light.edgeY, center = light.position;
    const glm::dvec3 normal = glm::normalize(glm::cross(ex, ey));
    const double size = std::sqrt(glm::length(glm::cross(ex, ey)));
    glm::dvec3 middle(0.0);
    for (uint32_t corner : t.corner) {
        const glm::dvec3 p = scene.positions[corner];
        if (std::abs(glm::dot(p - center, normal)) > size / 100) return false;
        middle += p / 3.0;
    }
    const double u = glm::dot(middle - center, ex) / glm::dot(ex, ex);
    const double v = glm::dot(middle - center, ey) / glm::dot(ey, ey);
    return std::abs(u) <= 0.5 && std::abs(v) <= 0.5;
}

std::optional<uint32_t> emissiveInstanceFor(const Scene& scene, const Light& light) {
    for (const Triangle& t : scene.triangles)
        if (scene.materials[t.material].emits() && standsFor(scene, t, light)) return t.instance;
    return std::nullopt;
}

void addEmitter(Scene& scene, const Light& light) {
    Material material;
    material.name = light.name + " (area light)";
    material.albedo = glm::vec3(0);
    material.emission = light.color;
    material.emitsBothSides = false;
    const auto materialIndex = uint32_t(scene.materials.size());
    scene.materials.push_back(material);
    const auto instance = uint32_t(scene.instances.size());
    scene.instances.push_back(light.name);

    // The corners in an order whose normal is the light's direction.
    glm::vec3 x = light.edgeX, y = light.edgeY;
    if (glm::dot(glm::cross(x, y), light.direction) < 0) std::swap(x, y);
    const auto first = uint32_t(scene.positions.size());
    const glm::vec3 b = light.position - 0.5f * x - 0.5f * y;
    const glm::vec3 c = b + x, a = b + y;
    for (const glm::vec3& p : {b, c, a + (c - b), a})
        scene.positions.push_back(p);
    const auto add = [&](uint32_t i, uint32_t j, uint32_t k) {
        Triangle t;
        t.corner[0] = first + i, t.corner[1] = first + j, t.corner[2] = first + k;
        t.material = materialIndex;
        t.instance = instance;
        scene.triangles.push_back(t);
        if (!scene.attributeCorners.empty())
            scene.attributeCorners.push_back({kNoAttributes, kNoAttributes, kNoAttributes});
    };
    add(0, 1, 3);
    add(1, 2, 3);
}

} // namespace

void resolveAreaLights(Scene& scene) {
    scene.framing = scene.bounds();
    std::vector<Light> kept;
    for (const Light& light : scene.lights) {
        if (light.kind != LightKind::Area) {
            kept.push_back(light);
        } else if (const auto instance = emissiveInstanceFor(scene, light)) {
            scene.report.ignored.push_back(
                fmt::format("area light '{}': the emissive mesh '{}' in its place is the emitter",
                            light.name, scene.instances[*instance]));
        } else {
            addEmitter(scene, light);
        }
    }
    scene.lights = std::move(kept);
}

} // namespace stromboli
