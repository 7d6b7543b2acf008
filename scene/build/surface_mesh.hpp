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

/// Drops the normals: the mesh is shaded flat.
void makeFlat(Mesh& mesh);

/// Makes the other side of every triangle its front.
void flip(Mesh& mesh);

/// Gives each corner the mean of the normals of the triangles that share its position and texture
/// coordinates, each weighed by the triangle's angle there (Thuermer and Wuethrich 1998), as
/// Mitsuba does where a file states none.
void computeNormals(Mesh& mesh);

} // namespace stromboli::build
