#pragma once

#include "host/kernel/weighed_lights.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

/// What is known of the samples of lights, by number.
struct KnownOfLights {
    std::vector<double> sent;    ///< second moments, with nothing in the way,
    std::vector<double> moments; ///< and of what arrives
    std::vector<double> costs;   ///< by that of a sample whose ray is not bent
    std::vector<bool> isHidden;  ///< next to nothing arrives
};

/// How these lights are best picked: each as often as pays by its moment and its cost, or as
/// WeighedLights::plain has it where little is gained. By an alias table some samples take no
/// light, in place of hidden ones. A part of them stays with the plain choice. sky: its number, or
/// NO_LIGHT.
HowLightsArePicked bestPicks(const WeighedLights& lights, const KnownOfLights& known, uint32_t sky);

} // namespace stromboli
