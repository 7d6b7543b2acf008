#pragma once

#include "host/farm/merge_films.hpp"
#include "host/farm/round_plan.hpp"
#include "host/render/picture_noise.hpp"

#include <optional>

namespace stromboli {

/// What comes after the rounds whose films there are.
struct NextRound {
    PictureNoise reached;          ///< the picture's noise until now
    std::optional<RoundPlan> plan; ///< empty: nothing is left to do
};

/// Spreads the samples of the next round as a render of one machine does those of its next pass
/// (NoisePlan): until the noise is at most `noise`; no pixel gets more than `mostSamples`. The same
/// films give the same plan. Throws UsageError if the films are incomplete or damaged.
NextRound planNextRound(FilmsToMerge& films, double noise, uint32_t mostSamples);

} // namespace stromboli
