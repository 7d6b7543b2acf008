#pragma once

#include "tests/analytic/scenes.hpp"

#include <optional>

namespace stromboli::test {

/// A unit sphere about the origin of `rows` x `columns` facets with the sphere's normals: a smooth
/// low-poly mesh. All corners lie on the sphere.
void addSmoothSphere(SceneMaker& builder, uint32_t rows, uint32_t columns, uint32_t material);

/// Gives triangle `index` these corner normals.
void setNormals(Scene& scene, size_t index, const glm::vec3& n0, const glm::vec3& n1,
                const glm::vec3& n2);

/// A point of a mesh as a flat triangle with interpolated normals has it, in double precision.
struct MeshPoint {
    glm::dvec3 position, geometric, shading;
};

/// The first triangle of the scene along a ray, tried one by one.
std::optional<MeshPoint> firstTriangle(const Scene& scene, const glm::dvec3& origin,
                                       const glm::dvec3& direction);

/// Largest angle between a corner's normal and its triangle's own, radians.
double largestTilt(const Scene& scene);

} // namespace stromboli::test
