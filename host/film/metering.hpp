#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <span>

namespace stromboli {

// What a picture tells about its light, by pixels that are neither background nor lamps: those
// with light, without the ones that are darker than 2^-12 of the luminance that 5 of 100 exceed;
// of the rest, without the darkest and the brightest 5 of 100. `colors` are linear (Rec. 709);
// pixels whose luminance is not finite or not positive have no light.

/// The exposure in stops that brings the mean of the metered pixels' logarithmic luminance to 0.18,
/// middle grey: the key of Reinhard et al. 2002. Rounded to hundredths, so that a user can give the
/// number that a message names; within [-100, 100]. 0 of a picture without light.
double meteredExposure(std::span<const glm::vec3> colors);

/// The temperature, in whole kelvin, of the illuminant under which the metered pixels would be grey
/// on the mean ("grey world", Buchsbaum 1980): the one nearest to the mean of their colours, of
/// which each counts the same whatever its luminance. Only the temperature is taken from the mean,
/// so that a meadow does not turn everything magenta. Nothing of a picture without light.
std::optional<double> meteredIlluminant(std::span<const glm::vec3> colors);

} // namespace stromboli
