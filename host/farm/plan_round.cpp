#include "host/farm/plan_round.hpp"

#include "host/core/error.hpp"
#include "host/farm/picture_parts.hpp"
#include "host/render/noise_plan.hpp"

#include <fmt/format.h>

#include <limits>

namespace stromboli {

NextRound planNextRound(FilmsToMerge& films, double noise, uint32_t mostSamples) {
    const FilmHeader& header = films.header();
    if (!header.isComplete())
        throw UsageError(fmt::format("the next round cannot be planned: {}", missingFrom(header)));
    RoundPlan plan;
    plan.picture = header;
    plan.picture.shares.clear();
    plan.picture.blocks.clear();
    for (PlannedRound& round : plan.picture.planned)
        round = {round.plan, round.samples, 0, {}, {}};

    const NoisePlan rule(mostSamples, header.settings.estimator.branches);
    std::vector<PartNoise> noises;
    PictureParts parts(header, [&](const Film& part, const NoiseEstimate& estimate) {
        noises.push_back({estimate.picture(part), part.pixels.size()});
        const auto first = plan.from.size();
        for (const PixelStatistics& p : part.pixels)
            plan.from.push_back(p.taken());
        plan.to.resize(plan.from.size());
        std::copy(plan.from.begin() + std::ptrdiff_t(first), plan.from.end(),
                  plan.to.begin() + std::ptrdiff_t(first));
        for (const PixelTarget& target :
             rule.next(part, estimate, std::numeric_limits<uint64_t>::max(), noise))
            plan.to[first + target.pixel] = target.samples;
    });
    films.addUp([&](const PictureArea&, std::span<const SharedPixel> run) { parts.add(run); });
    NextRound next{togetherOf(noises), std::nullopt};
    if (plan.samples() > 0) next.plan = std::move(plan);
    return next;
}

} // namespace stromboli
