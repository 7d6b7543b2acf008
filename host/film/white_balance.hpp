#pragma once

#include "host/core/chromaticity.hpp"

#include <glm/glm.hpp>

namespace stromboli {

/// Illuminants are known between these temperatures, in kelvin.
inline constexpr double kLeastKelvin = 1000, kMostKelvin = 25000;

/// The colour of light of a correlated colour temperature in [kLeastKelvin, kMostKelvin]: of a
/// black body up to 4000 K, as of candles and lamps with a filament; of daylight from 5000 K on.
Chromaticity illuminantOf(double kelvin);

/// For linear colours with the primaries of Rec. 709: a white surface under the illuminant becomes
/// white, of the same luminance, and all other colours what they would be under D65.
glm::dmat3 whiteBalance(double kelvin);

/// The temperature, in whole kelvin, of the illuminant whose colour is nearest to that of linear
/// light (Rec. 709, no channel negative, not black), by distance in CIE's 1960 diagram.
double nearestTemperature(const glm::dvec3& light);

} // namespace stromboli
