#pragma once

#include "host/core/random.hpp"
#include "scene/model/scene.hpp"

namespace stromboli {

/// Each mesh has one diffuse material; corners are shared between triangles.

/// A closed mesh, every ray from whose middle meets it: an octahedron, each triangle divided into
/// 4^levels, its corners at random distances of 0.6 to 1.4 from the origin.
Scene starMesh(uint32_t levels, Random& random);

/// Heights 0 to 3, whole numbers at random, over the whole numbers 0 .. n of x and z; y is up.
Scene integerTerrain(uint32_t n, Random& random);

/// A closed unit sphere of `rings` bands from pole to pole (the z axis), each of 2 * rings squares
/// of two triangles.
Scene tessellatedSphere(uint32_t rings);

/// Triangles and spheres of extent about `size` in the cube [-1, 1]^3.
Scene soup(uint32_t triangles, uint32_t spheres, float size, Random& random);

/// Each position moved by `by`, then rounded to float.
void translate(Scene& scene, const glm::vec3& by);

} // namespace stromboli
