#pragma once

#include "scene/collada/context.hpp"

#include <glm/glm.hpp>

namespace stromboli::collada {

/// Adds a <light> placed by `toWorld` to the scene. Lights without a place or a direction in the
/// world (a singular matrix, coordinates beyond 2^60) are left out with a warning. Throws
/// SceneError for values that make no sense.
void placeLight(Context& context, const Element& light, const glm::dmat4& toWorld);

} // namespace stromboli::collada
