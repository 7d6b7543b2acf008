#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/light.hpp"

#include <glm/glm.hpp>

namespace stromboli::build {

/// Sets where and how a light of a set kind stands in the world; false if the matrix leaves it no
/// place, direction or area.
bool poseLight(Light& light, const glm::dmat4& toWorld, const SceneConventions& conventions);

} // namespace stromboli::build
