#pragma once

#include "scene/build/mesh.hpp"

namespace stromboli::mitsuba {

/// Mitsuba's shapes of formulas as triangles, with its texture coordinates. Spheres, disks and
/// cylinders become polyhedra whose corners lie on them, of kSides sides around: between these, the
/// surface is off by 1 - cos(pi / kSides), 7.5e-5, of the radius at most.
inline constexpr uint32_t kSides = 256;

build::Mesh rectangleMesh(); ///< [-1, 1]^2 in the xy plane, facing z
build::Mesh cubeMesh();      ///< [-1, 1]^3
build::Mesh diskMesh();      ///< of radius 1 in the xy plane, facing z
build::Mesh sphereMesh();    ///< of radius 1 about the origin
build::Mesh cylinderMesh(const glm::dvec3& from, const glm::dvec3& to, double radius); ///< open

} // namespace stromboli::mitsuba
