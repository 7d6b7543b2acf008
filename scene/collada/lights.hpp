#pragma once

#include "scene/collada/context.hpp"

#include <glm/glm.hpp>

namespace stromboli::collada {

/// What becomes of lights that are not there, or say nothing.
inline constexpr const char* kNoLight = "the light is left out";

/// Adds a <light> placed by `toWorld` to the scene. Throws SceneError for values that make no
/// sense.
void placeLight(Context& context, const Element& light, const glm::dmat4& toWorld);

} // namespace stromboli::collada
