#pragma once

#include "scene/build/metals.hpp"
#include "scene/pbrt/context.hpp"
#include "scene/pbrt/parameters.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace stromboli::pbrt {

/// What a colour is of: spectra mean different colours as light and as fractions of it, or as
/// numbers of any size, such as indices of refraction.
enum class ColorOf { Light, Reflectance, Number };

/// A parameter that is a colour, in linear light of Rec. 709 primaries. Nothing if there is none,
/// or if it is a texture. Spectra of light and black bodies have the luminance 1 in pbrt-v4, and
/// are taken as they are in pbrt-v3, where the peak of a black body is 1.
std::optional<glm::dvec3> colorOf(const Context& context, const Parameters& parameters,
                                  std::string_view name, ColorOf what);

double luminance(const glm::dvec3& rgb);

/// Light of a black body whose spectrum has the peak 1, above 0 kelvins.
glm::dvec3 blackbodyOfPeak(double kelvins);

/// Index of refraction of what is inside; that of glasses by name is the one of yellow light.
double indexOf(const Context& context, const Parameters& parameters, double otherwise);
/// The one that a parameter of that name states.
double indexOf(const Context& context, const Parameters& parameters, const char* name,
               double otherwise);

/// What parameters state of a metal, or copper.
build::MetalIndex metalOf(const Context& context, const Parameters& parameters,
                          const std::string& eta, const std::string& k);

/// Fractions of light that a metal reflects where it is looked at straight.
glm::dvec3 facingReflectance(const build::MetalIndex& metal);
/// One that reflects such fractions: with the index 1, as pbrt-v4 has it.
build::MetalIndex metalOfReflectance(const glm::dvec3& reflectance);

/// Turns a colour of one of pbrt-v4's colour spaces into one of Rec. 709; nothing where there is no
/// such space.
std::optional<glm::dmat3> rec709From(std::string_view colorSpace);

} // namespace stromboli::pbrt
