#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

namespace stromboli {

/// The fog that a user asks for: the same everywhere about a scene.
struct FogRequest {
    double density = 0;     ///< extinction per metre; 0: there is none
    glm::vec3 color{1.0f};  ///< the share of light that is scattered and not absorbed, [0, 1]
    double asymmetry = 0.0; ///< mean cosine of its phase function (scene/model/medium.hpp)

    bool isGiven() const { return density > 0; }
};

/// Fills the scene with fog; what is in volumes that surfaces bound stays as it is. Where light
/// comes from infinity, the fog is a ball about the scene, which that light comes through.
void addFog(Scene& scene, const FogRequest& request);

} // namespace stromboli
