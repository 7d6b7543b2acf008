#pragma once

#include <glm/glm.hpp>

#include <span>
#include <utility>
#include <vector>

namespace stromboli::build {

/// What equal power at all wavelengths looks like in Rec. 709 primaries, of luminance 1.
inline constexpr glm::dvec3 kEqualEnergy{1.2048, 0.9483, 0.9089};

/// Red, green and blue (Rec. 709) of a spectrum given at some wavelengths in nanometres, linear
/// between them and 0 outside: of light, of which equal power 1 at all wavelengths has luminance 1
/// (kEqualEnergy), or of what a surface reflects under the illuminant D65, where 1 at all
/// wavelengths is white. The CIE 1931 curves are the fits of C. Wyman, P.-P. Sloan and P. Shirley,
/// "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", 2013, which are off by
/// about 1 % of their largest values; they are scaled so that what is alike at all wavelengths
/// comes out exactly.
glm::dvec3 rgbOfLight(std::span<const std::pair<double, double>> samples);
glm::dvec3 rgbOfReflectance(std::span<const std::pair<double, double>> samples);

/// What a black body of a temperature in kelvins emits, from 360 to 830 nanometres:
/// W m^-2 sr^-1 nm^-1.
std::vector<std::pair<double, double>> blackbody(double temperature);

} // namespace stromboli::build
