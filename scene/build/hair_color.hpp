#pragma once

#include <glm/glm.hpp>

namespace stromboli::build {

/// What hair absorbs along its diameter by its melanin: concentrations of the dark and of the red
/// kind, of which 1.3 and 0 are brown hair (Chiang et al., "A Practical and Controllable Hair and
/// Fur Model", 2016).
glm::dvec3 absorptionOfHair(double eumelanin, double pheomelanin);

/// The colour of much hair that absorbs so much. roughness: about its axis, in [0, 1].
glm::dvec3 colorOfHair(const glm::dvec3& absorption, double roughness);

} // namespace stromboli::build
