#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <optional>

namespace stromboli {

/// A floor that a user asks for.
struct GroundRequest {
    bool isGiven = false;
    glm::vec3 color{0.5f}; ///< the share of light that it reflects diffusely, [0, 1]
    /// What it lies under; empty: the scene that it is added to.
    std::optional<Bounds> under{};
};

/// Puts a floor under all there is, a hair below its lowest point, and so wide that its edge is on
/// the horizon. Cameras frame what was there before.
void addGround(Scene& scene, const GroundRequest& request);

} // namespace stromboli
