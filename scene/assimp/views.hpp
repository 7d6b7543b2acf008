#pragma once

#include "scene/build/scene_builder.hpp"

#include <assimp/scene.h>
#include <glm/glm.hpp>

namespace stromboli::assimp {

/// Adds a light, or a camera, of a node with this matrix to the world. unit: metres of a length of
/// the file, in which lights fall off. decaysFromOneMetre: for FBX files, of whose lamps Assimp
/// makes the coefficients from where a modeller begins to draw the decay, which says nothing of the
/// light: they say how a lamp fades, and its intensity is that at one metre.
void placeLight(const aiLight& light, const glm::dmat4& toWorld, double unit,
                bool decaysFromOneMetre, build::SceneBuilder& builder);
void placeCamera(const aiCamera& camera, const glm::dmat4& toWorld, build::SceneBuilder& builder);

} // namespace stromboli::assimp
