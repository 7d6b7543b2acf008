#pragma once

#include "scene/build/mesh.hpp"

#include <cstdint>
#include <functional>

namespace stromboli::build {

/// A point of a surface that a formula gives.
struct SurfacePoint {
    glm::dvec3 position{0.0}, normal{0.0};
    glm::dvec2 uv{0.0};
};

/// A grid of columns x rows quadrangles over a surface given by (s, t) in [0, 1]^2, whose normal is
/// on the side from which s, t run counter-clockwise. Its texture coordinates are not turned upside
/// down.
Mesh gridMesh(uint32_t columns, uint32_t rows,
              const std::function<SurfacePoint(double, double)>& at);

/// A polyhedron whose corners lie on the sphere of radius 1 about the origin, of `sides` sides
/// around and half as many from pole to pole: between its corners it is off by 1 - cos(pi / sides)
/// of the radius at most. Texture coordinates are those of Mitsuba: round the z axis, and from its
/// far end.
Mesh sphereMesh(uint32_t sides);

/// Sides of what is round by nature: 7.5e-5 of the radius is less than a pixel shows.
inline constexpr uint32_t kSphereSides = 256;

/// Drops the normals: the mesh is shaded flat.
void makeFlat(Mesh& mesh);

/// Makes the other side of every triangle its front.
void flip(Mesh& mesh);

/// Gives each corner the mean of the normals of the triangles that share its position and texture
/// coordinates, each weighed by the triangle's angle there (Thuermer and Wuethrich 1998), as
/// Mitsuba does where a file states none.
void computeNormals(Mesh& mesh);

} // namespace stromboli::build
