#pragma once

#include "scene/model/medium.hpp"
#include "scene/pbrt/context.hpp"
#include "scene/pbrt/parameters.hpp"

#include <glm/glm.hpp>

namespace stromboli::pbrt {

// What varies from place to place in media that list it: nx times ny times nz values in the box
// from p0 to p1. Throw SceneError where there are more or fewer.

/// Numbers.
DensityGrid gridOf(const Parameters& parameters, const char* name,
                   const glm::dmat4& worldFromMedium);

/// A grid of so many cells in the box from p0 to p1, without values.
DensityGrid emptyDensity(const Parameters& parameters, const glm::dmat4& worldFromMedium,
                         const glm::uvec3& cells);

/// rgbgrid: absorption, scattering and what shines by colour. scale: of the first two.
void readColoredGrid(const Parameters& parameters, double scale, const glm::dmat4& worldFromMedium,
                     Medium& medium);

/// What shines in a grid of densities that `medium` has already: a colour or temperatures, times
/// factors that may vary.
void readGridEmission(const Context& context, const Parameters& parameters, Medium& medium);

/// nanovdb: densities and maybe temperatures of a file. Reports what was left out of them.
void readNanoMedium(const Context& context, const Parameters& parameters,
                    const glm::dmat4& worldFromMedium, Medium& medium);

/// Makes all that it sends out so many times stronger.
void strengthen(Medium& medium, double factor);

/// pbrt-v4 divides light of lamps by what the eye's curve has of it, and that of grids of
/// temperatures or colours not: it is so many times stronger, by the integral of the CIE's curve.
inline constexpr double kUnscaledLight = 106.856895;

/// Light of black bodies up to that temperature, each with the peak 1 of its spectrum.
GlowTable glowTable(double hottest);

} // namespace stromboli::pbrt
