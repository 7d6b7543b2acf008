#pragma once

#include "scene/model/placements.hpp"
#include "scene/model/scene.hpp"

#include <array>

namespace stromboli {

/// Calls take(corners, facing, index, instance) for each triangle of a material for which
/// wanted(material) holds, wherever it is placed. corners: in world space, as placed() rounds them;
/// facing: 1, or -1 where the placement mirrors, so that the normal points to the other side;
/// index: into Scene::triangles; instance: into Scene::instances.
template <class Wanted, class Take>
void forTrianglesInWorld(const Scene& scene, const Wanted& wanted, const Take& take) {
    const auto takeWanted = [&](uint32_t index, double facing, const uint32_t* instance,
                                const auto& toWorld) {
        const Triangle& t = scene.triangles[index];
        if (!wanted(scene.materials[t.material])) return;
        std::array<glm::dvec3, 3> corners;
        for (size_t i = 0; i < 3; ++i)
            corners[i] = toWorld(scene.positions[t.corner[i]]);
        take(corners, facing, index, instance ? *instance : t.instance);
    };
    for (uint32_t i = uint32_t(scene.firstInWorld()); i < scene.triangles.size(); ++i)
        takeWanted(i, 1.0, nullptr, [](const glm::vec3& p) { return p; });
    for (const Placement& placement : scene.placements) {
        const Prototype& prototype = scene.prototypes[placement.prototype];
        const glm::dmat3 turn(glm::dvec3(placement.toWorld[0]), glm::dvec3(placement.toWorld[1]),
                              glm::dvec3(placement.toWorld[2]));
        const double facing = glm::determinant(turn) < 0 ? -1 : 1;
        for (uint32_t i = 0; i < prototype.triangles; ++i)
            takeWanted(prototype.firstTriangle + i, facing, &placement.instance,
                       [&](const glm::vec3& p) { return placed(placement, p); });
    }
}

} // namespace stromboli
