#pragma once

#include "scene/model/scene.hpp"

#include <array>

namespace stromboli {

/// Calls take(corners, facing, index) for each triangle of a material for which wanted(material)
/// holds, wherever it is placed. corners: in world space; facing: 1, or -1 where the placement
/// mirrors, so that the normal points to the other side; index: into Scene::triangles.
template <class Wanted, class Take>
void forTrianglesInWorld(const Scene& scene, const Wanted& wanted, const Take& take) {
    const auto cornersOf = [&](const Triangle& t, const auto& toWorld) {
        std::array<glm::dvec3, 3> corners;
        for (size_t i = 0; i < 3; ++i)
            corners[i] = toWorld(glm::dvec3(scene.positions[t.corner[i]]));
        return corners;
    };
    const auto isWanted = [&](uint32_t i) {
        return wanted(scene.materials[scene.triangles[i].material]);
    };
    for (uint32_t i = uint32_t(scene.firstInWorld()); i < scene.triangles.size(); ++i)
        if (isWanted(i))
            take(cornersOf(scene.triangles[i], [](const glm::dvec3& p) { return p; }), 1.0, i);
    for (const Placement& placement : scene.placements) {
        const Prototype& prototype = scene.prototypes[placement.prototype];
        const auto toWorld = [&](const glm::dvec3& p) {
            glm::dvec3 world;
            for (int i = 0; i < 3; ++i) {
                const glm::dvec4 row(placement.toWorld[size_t(i)]);
                world[i] = glm::dot(glm::dvec3(row), p) + row.w;
            }
            return world;
        };
        const glm::dmat3 turn(glm::dvec3(placement.toWorld[0]), glm::dvec3(placement.toWorld[1]),
                              glm::dvec3(placement.toWorld[2]));
        const double facing = glm::determinant(turn) < 0 ? -1 : 1;
        for (uint32_t i = 0; i < prototype.triangles; ++i)
            if (isWanted(prototype.firstTriangle + i))
                take(cornersOf(scene.triangles[prototype.firstTriangle + i], toWorld), facing,
                     prototype.firstTriangle + i);
    }
}

} // namespace stromboli
