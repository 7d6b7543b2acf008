#pragma once

#include "scene/build/mesh.hpp"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace stromboli::build {

/// The vertex normals of VertexNormals::Recomputed, one per position; NaN or zero where there is
/// none. `positions` in world space.
/// - Inside the mesh: the sum of the cross products of the triangles around the vertex.
/// - On the boundary: the renderers that recompute normals walk around the neighbour n that follows
///   the vertex v along the open edge (the boundary loop runs against the triangles' winding), with
///   v as the apex, and take the loop for a triangle like the others. The sum is that of
///   (n - v) x (m - v) over all neighbours m of n: minus the winding's normal if everything is
///   plane and convex.
std::vector<glm::dvec3> recomputedVertexNormals(std::span<const glm::dvec3> positions,
                                                std::span<const MeshPart> parts);

} // namespace stromboli::build
