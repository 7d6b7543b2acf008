#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace stromboli {

/// The light around a scene that a user asks for.
struct EnvironmentRequest {
    std::string file; ///< an equirectangular picture, or a bundled one's name; empty: none
    std::optional<glm::vec3> constant; ///< in place of a file: the same radiance from everywhere
    double rotationDegrees = 0;        ///< about +y, counter-clockwise seen from above
    double strength = 1;               ///< multiplies the radiance
    uint32_t largestSide = 0;          ///< a larger picture is shrunk; 0: as large as may be
    bool strict = false;               ///< what is wrong with the picture is an error

    bool isGiven() const { return !file.empty() || constant; }
};

/// Puts the environment around the scene, in the place of its ambient lights, which it reports.
/// Throws SceneError if the file cannot be read.
void addEnvironment(Scene& scene, const EnvironmentRequest& request);
/// Does the same with an environment that is there.
void addEnvironment(Scene& scene, Environment environment);

} // namespace stromboli
