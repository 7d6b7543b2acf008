#pragma once

#include "scene/build/surface_mesh.hpp"

namespace stromboli::mitsuba {

/// Mitsuba's shapes of formulas as triangles, with its texture coordinates (spheres:
/// build::sphereMesh()). Disks and cylinders have as many sides as spheres.
inline constexpr uint32_t kSides = build::kSphereSides;

build::Mesh rectangleMesh(); ///< [-1, 1]^2 in the xy plane, facing z
build::Mesh cubeMesh();      ///< [-1, 1]^3
build::Mesh diskMesh();      ///< of radius 1 in the xy plane, facing z
/// Without ends. Mitsuba 0.x (`isOld`) has other coordinates about an axis that is neither y nor z.
build::Mesh cylinderMesh(const glm::dvec3& from, const glm::dvec3& to, double radius, bool isOld);

} // namespace stromboli::mitsuba
