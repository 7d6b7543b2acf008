#pragma once

#include "scene/model/material.hpp"

#include <span>
#include <vector>

namespace stromboli {

/// A mixture is of so many materials at most; what is behind them in its chain is left out.
inline constexpr size_t kMostOfAMixture = 256;

/// The materials that one is a mixture of, by their numbers: itself, the other one in its place,
/// the other one's other, and so on.
std::vector<uint32_t> materialsOfMixture(std::span<const Material> materials, uint32_t first);

/// Whether all materials of a mixture scatter in one frame and leave light in one medium, so that
/// the values and densities of all can be added for a pair of directions. Where one of them has a
/// normal of its own, is black behind or bounds a volume, or is on one side only, a mixture is
/// drawn: a path meets one of its materials and knows nothing of the others. materials: those of
/// the mixture; one is none.
bool areEvaluatedTogether(std::span<const Material> materials, std::span<const uint32_t> mixture);

} // namespace stromboli
