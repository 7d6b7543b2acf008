#pragma once

#include "scene/collada/context.hpp"

#include <glm/glm.hpp>

namespace stromboli::collada {

/// What becomes of cameras that are not there, or say nothing.
inline constexpr const char* kNoCamera = "the camera is left out";

/// Adds a <camera> placed by `toWorld` to the scene. Throws SceneError for values that make no
/// sense: fields of view outside (0, 180) degrees, no field of view at all, ...
void placeCamera(Context& context, const Element& camera, const glm::dmat4& toWorld);

} // namespace stromboli::collada
