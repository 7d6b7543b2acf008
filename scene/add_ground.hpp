#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

namespace stromboli {

/// A floor that a user asks for.
struct GroundRequest {
    bool isGiven = false;
    glm::vec3 color{0.5f}; ///< the share of light that it reflects diffusely, [0, 1]
};

/// Puts a floor under all there is, a hair below its lowest point, and so wide that its edge is on
/// the horizon. Cameras frame what was there before.
void addGround(Scene& scene, const GroundRequest& request);

} // namespace stromboli
