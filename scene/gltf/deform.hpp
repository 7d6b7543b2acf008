#pragma once

#include "scene/gltf/primitives.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace stromboli::gltf {

/// Adds the displacements of morph targets, each times its weight. Weights that are not given are
/// 0.
void applyTargets(Primitive& primitive, std::span<const double> weights);

/// Moves each vertex by the mean of the joints' matrices, with its weights: linear blend skinning.
/// Normals turn by the inverse transpose of that mean. `joints`: from the mesh's space to where the
/// skin is placed. Returns how many vertices have no weight: they move with their first joint.
/// Throws SceneError, at `element`, for joints that are not there.
size_t applySkin(Primitive& primitive, const std::vector<glm::dmat4>& joints,
                 const Element& element);

} // namespace stromboli::gltf
