#pragma once

#include "scene/model/medium.hpp"
#include "scene/pbrt/parameters.hpp"

#include <glm/glm.hpp>

namespace stromboli::pbrt {

/// The densities of pbrt-v4's medium 'cloud', sums of noise in the box from p0 to p1 that get
/// thinner upwards: a grid of them.
DensityGrid cloudOf(const Parameters& parameters, const glm::dmat4& worldFromMedium);

} // namespace stromboli::pbrt
