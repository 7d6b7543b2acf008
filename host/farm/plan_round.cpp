#include "host/farm/plan_round.hpp"

#include "host/core/error.hpp"
#include "host/render/noise_plan.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace stromboli {

NextRoundPlanner::NextRoundPlanner(const FilmHeader& header, double noise, uint32_t mostSamples)
    : noise_(noise), mostSamples_(mostSamples),
      parts_(header, [this](const Film& part, const NoiseEstimate& estimate, const FloatImage&) {
          plan(part, estimate);
      }) {
    if (!header.isComplete())
        throw UsageError(fmt::format("the next round cannot be planned: {}", missingFrom(header)));
    plan_.picture = header;
    plan_.picture.shares.clear();
    plan_.picture.blocks.clear();
    plan_.picture.holdsLayers = false;
    for (PlannedRound& round : plan_.picture.planned)
        round = {round.plan, round.samples, 0, {}, {}};
}

void NextRoundPlanner::plan(const Film& part, const NoiseEstimate& estimate) {
    noises_.push_back({estimate.picture(part), part.pixels.size()});
    const size_t first = plan_.from.size();
    for (const PixelStatistics& p : part.pixels) {
        plan_.from.push_back(p.taken());
        plan_.to.push_back(p.taken());
    }
    const NoisePlan rule(mostSamples_, part.branches);
    for (const PixelTarget& target :
         rule.next(part, estimate, std::numeric_limits<uint64_t>::max(), noise_))
        plan_.to[first + target.pixel] = target.samples;
}

NextRound NextRoundPlanner::finish() {
    NextRound next{togetherOf(noises_), std::nullopt};
    if (plan_.samples() > 0) next.plan = std::move(plan_);
    return next;
}

NextRound planNextRound(FilmsToMerge& films, double noise, uint32_t mostSamples) {
    NextRoundPlanner planner(films.header(), noise, mostSamples);
    films.addUp([&](const PictureArea&, std::span<const SharedPixel> run, std::span<const float>) {
        planner.add(run);
    });
    return planner.finish();
}

} // namespace stromboli
