#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace stromboli {

/// A clear sky with its sun. Angles are degrees.
struct SunRequest {
    double azimuth = 0;    ///< clockwise from -z seen from above, as on a compass: 90 is +x
    double elevation = 45; ///< above the horizon, 0 to 90
    double turbidity = 3;  ///< haze, 1 to 10
};

/// The light around a scene that a user asks for.
struct EnvironmentRequest {
    std::string file; ///< an equirectangular picture, or a bundled one's name; empty: none
    std::optional<glm::vec3> constant; ///< in place of a file: the same radiance from everywhere
    /// In place of both, over a grey ground without end. Its radiance is that of skies divided by
    /// kDaylight.
    std::optional<SunRequest> sun;
    double rotationDegrees = 0; ///< about +y, counter-clockwise seen from above
    double strength = 1;        ///< multiplies the radiance
    uint32_t largestSide = 0;   ///< a larger picture is shrunk; 0: as large as may be
    bool strict = false;        ///< what is wrong with the picture is an error

    bool isGiven() const { return !file.empty() || constant || sun; }
};

/// Under the sun of SunRequest{} white paper on the ground has the radiance 1 (luminance) where
/// skies have this one, in the unit of scene/sky.
inline constexpr double kDaylight = 0.357;

/// Environment::rotation of an environment of the request; of the file's own one where `ofFile` is
/// what it has there.
float rotationOf(const EnvironmentRequest& request, float ofFile = 0);

/// The picture of the sky and its sun. Its azimuth is its rotation, and nothing else.
Environment environmentOf(const SunRequest& request);

/// Puts the environment around the scene, in the place of its ambient lights, which it reports.
/// Throws SceneError if the file cannot be read.
void addEnvironment(Scene& scene, const EnvironmentRequest& request);
/// Does the same with an environment that is there.
void addEnvironment(Scene& scene, Environment environment);

} // namespace stromboli
