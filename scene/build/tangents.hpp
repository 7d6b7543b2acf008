#pragma once

#include "scene/build/mesh.hpp"

#include <cstddef>

namespace stromboli::build {

/// Gives every corner of a part a unit tangent, along which u of a set of texture coordinates
/// grows, and the sense of its bitangent: +1 where the picture is not mirrored. Textures have v
/// growing downwards, so the bitangent w (normal x tangent) points to where v falls, which is up on
/// the picture, as normal maps mean it.
///
/// As in M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, chapter 2, and the
/// MikkTSpace that programs bake normal maps with: corners with the same position, normal and
/// texture coordinates share a tangent, apart from those of triangles that the picture covers
/// mirrored, which share another. It is the sum over their triangles of the derivative of the
/// position by u, projected into the plane across the normal and made unit, times the corner's
/// angle in that plane. Triangles without area in the picture have no derivative: their corners
/// take the tangent of other triangles at the same place, or else any direction across the normal.
/// Corners without attributes get them.
void computeTangents(Mesh& mesh, size_t part, int uvSet);

/// Gives the corners of a part, which have tangents along the coordinates (u, v), those along
/// u' = (uRow.x u + uRow.y v) and v' of vRow: turned as they are turned, and of the other sense
/// where they are mirrored. Tangent and bitangent are taken to be of one length.
void turnTangents(Mesh& mesh, size_t part, const glm::dvec2& uRow, const glm::dvec2& vRow);

} // namespace stromboli::build
