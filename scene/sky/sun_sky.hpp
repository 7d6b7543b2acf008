#pragma once

#include "scene/model/environment.hpp"

#include <glm/glm.hpp>

namespace stromboli::sky {

/// A clear sky with its sun, as a picture around a world. Directions are in the sky's own space, z
/// up.
struct SunSky {
    double turbidity = 3; ///< haze: 1 to 10
    double sunScale = 1, skyScale = 1;
    double halfAperture = 0; ///< of the sun's disk, radians; 0: it is not in the picture
    bool goesOn = false;     ///< below the horizon, ever darker
    glm::dvec3 albedo{0.3};  ///< of the ground that lights the sky from below, [0, 1]
    glm::dvec3 sun{0, 0, 1}; ///< unit, towards it; not below the horizon
    glm::dmat3 skyFromWorld{1.0};
};

/// What the sun brings to a surface that faces it: that of the real one, however large its disk is.
/// byPreetham: as Mitsuba 0.x has it (sun_radiance.hpp), else as SkyModel has it.
glm::dvec3 sunIrradiance(const SunSky& s, bool byPreetham = false);

/// The picture, with a sun of this irradiance where it has a disk. Below the horizon it is black
/// unless the sky goes on.
Environment sunSkyPicture(const SunSky& s, const glm::dvec3& sunIrradiance);

/// What is seen of a grey ground where the sky is over it, put into the black part of the picture
/// of a world whose y points up: albedo / pi of what the sky and the sun bring to it.
void addGround(Environment& picture, const glm::dvec3& albedo);

} // namespace stromboli::sky
