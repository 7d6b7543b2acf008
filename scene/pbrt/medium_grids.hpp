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

/// rgbgrid: absorption, scattering and what shines by colour. scale: of the first two.
void readColoredGrid(const Parameters& parameters, double scale, const glm::dmat4& worldFromMedium,
                     Medium& medium);

/// What shines in a grid of densities that `medium` has already: a colour or temperatures, times
/// factors that may vary.
void readGridEmission(const Context& context, const Parameters& parameters, Medium& medium);

/// nanovdb: densities and maybe temperatures of a file. Reports what was left out of them.
void readNanoMedium(const Context& context, const Parameters& parameters,
                    const glm::dmat4& worldFromMedium, Medium& medium);

/// Light of black bodies up to that temperature, each with the peak 1 of its spectrum.
GlowTable glowTable(double hottest);

} // namespace stromboli::pbrt
