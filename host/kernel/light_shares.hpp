#pragma once

#include "host/kernel/weighed_lights.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace stromboli {

/// What is known of the samples of a light: means over the places that asked for it.
struct KnownLight {
    double sent = 0,     ///< second moments: with nothing in the way,
        arrived = 0;     ///< and of what arrives
    double segments = 1; ///< of their rays, which clear glass bends
    size_t places = 0;
};

/// How these lights, by number, are best picked: each as often as pays by the noise that it makes
/// and the time that its samples take, or as WeighedLights::plain has it where little is gained. By
/// an alias table some samples take no light, in place of hidden ones, of which next to nothing
/// arrives. A part of the samples stays with the plain choice. sky: the number of the sky, or
/// NO_LIGHT.
HowLightsArePicked bestPicks(const WeighedLights& lights, std::span<const KnownLight> known,
                             uint32_t sky);

} // namespace stromboli
