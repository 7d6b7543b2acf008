#pragma once

#include "host/farm/merge_films.hpp"
#include "host/farm/picture_parts.hpp"
#include "host/farm/round_plan.hpp"
#include "host/render/picture_noise.hpp"

#include <optional>
#include <span>
#include <vector>

namespace stromboli {

/// What comes after the rounds whose films there are.
struct NextRound {
    PictureNoise reached;          ///< the picture's noise until now
    std::optional<RoundPlan> plan; ///< empty: nothing is left to do
};

/// Spreads the samples of the next round as a render of one machine does those of its next pass
/// (NoisePlan): until the noise is at most `noise`; no pixel gets more than `mostSamples`. The same
/// films give the same plan.
class NextRoundPlanner {
  public:
    /// header: of all films together. Throws UsageError if they are incomplete.
    NextRoundPlanner(const FilmHeader& header, double noise, uint32_t mostSamples);
    NextRoundPlanner(const NextRoundPlanner&) = delete; // parts_ knows where it is
    /// The next run of rows, from the top.
    void add(std::span<const SharedPixel> run) { parts_.add(run); }
    /// To be called once, after the last run.
    NextRound finish();

  private:
    void plan(const Film& part, const NoiseEstimate& estimate);

    double noise_;
    uint32_t mostSamples_;
    RoundPlan plan_;
    std::vector<PartNoise> noises_;
    PictureParts parts_;
};

/// Of films in files. Throws UsageError if they are incomplete or damaged.
NextRound planNextRound(FilmsToMerge& films, double noise, uint32_t mostSamples);

} // namespace stromboli
