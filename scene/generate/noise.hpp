#pragma once

#include <glm/glm.hpp>

namespace stromboli {

/// Smooth random numbers: value noise on the integer lattice, in [-1, 1], the same everywhere.
double valueNoise(const glm::dvec2& p);

/// Sum of `octaves` value noises, each twice as fine and half as strong as the one before, scaled
/// to [-1, 1].
double fractalNoise(const glm::dvec2& p, int octaves);

/// As fractalNoise, folded so that it has narrow, rounded crests: in [-0.02, 0.85], 0.85
/// on the crests.
double ridgedNoise(const glm::dvec2& p, int octaves);

} // namespace stromboli
