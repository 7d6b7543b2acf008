// `plan`: films of the rounds until now say where the samples of the next one go.
#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/exit_code.hpp"
#include "host/cli/report.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/log.hpp"
#include "host/farm/round_plan.hpp"

#include <fmt/format.h>

#include <memory>

namespace stromboli {
namespace {

/// The most samples of a pixel; -s counts paths.
uint32_t mostSamplesOf(const FilmHeader& header, const PlanOptions& options) {
    if (!options.mostPaths) return kMostSamples;
    const uint32_t paths = *options.mostPaths;
    const uint32_t branches = header.settings.estimator.branches;
    if (paths % branches != 0)
        throw UsageError(fmt::format("-s {} is not a multiple of the {} --branches of the films",
                                     paths, branches));
    return paths / branches;
}

void sayWhyNothingIsLeft(const PictureNoise& reached, double noise) {
    const std::string words = inWords(reached);
    if (reached.known() && reached.most <= noise)
        logging::info(fmt::format("nothing is left to do: {}; at most {} % is asked for", words,
                                  percent(noise)));
    else if (reached.unknown == PictureNoise::Unknown::Black)
        logging::info(fmt::format("nothing is left to do: {}", words));
    else
        logging::warn(fmt::format("nothing is left to do: all pixels have the samples of -s; {}, "
                                  "and at most {} % is asked for",
                                  words, percent(noise)));
}

void sayWhatIsPlanned(const NextRound& next, double noise) {
    const RoundPlan& plan = *next.plan;
    const double pixels = double(plan.from.size());
    const double paths = plan.picture.settings.estimator.branches;
    logging::info(fmt::format(
        "round {}: {} samples more, for {} of {} pixels: from {:.6g} to {:.6g} a pixel on the mean",
        plan.round(), plan.samples() * uint64_t(paths), plan.pixels(), plan.from.size(),
        paths * double(plan.picture.samplesInAll()) / pixels,
        paths * double(plan.picture.samplesInAll() + plan.samples()) / pixels));
    logging::info(
        fmt::format("{}; at most {} % is asked for", inWords(next.reached), percent(noise)));
}

} // namespace

void declarePlan(DeclaredCommand& c) {
    const auto owned = std::make_shared<PlanOptions>();
    PlanOptions& o = *owned;
    c.list.group("Films");
    c.list
        .list("FILM", "",
              "all films of the rounds until now, of render --share or merge, in any "
              "order",
              o.films)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Output");
    c.list
        .text("-o,--output", "FILE.plan",
              "the plan of the next round, for render --plan; nothing is written, and the exit "
              "code is 7, if nothing is left to do",
              o.file)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Sampling");
    declareNoise(c.list,
                 "the noise to reach, as of render: the square root of the picture's relMSE is at "
                 "most T (0.02: 2 %) in 95 of 100 renders",
                 o.noise)
        .required();
    c.list.number("-s,--samples", "N", "the most samples of a pixel, over all rounds", o.mostPaths,
                  {1, kMostSamples});
    declareHost(c);
    c.finish = [owned] {
        if (!namesPlan(owned->file))
            throw UsageError(
                fmt::format("{}: plan writes a plan, whose name must end in .plan", owned->file));
        return *owned;
    };
}

int planCommand(const PlanOptions& options) {
    nowDoing(fmt::format("adding up {} films", options.films.size()));
    checkFileWritable(options.file);
    FilmsToMerge films({options.films.begin(), options.films.end()});
    const double noise = options.noise;
    const NextRound next = planNextRound(films, noise, mostSamplesOf(films.header(), options));
    if (!next.plan) {
        sayWhyNothingIsLeft(next.reached, noise);
        return int(ExitCode::NothingLeft);
    }
    nowDoing("writing " + options.file);
    writePlan(options.file, *next.plan);
    sayWhatIsPlanned(next, noise);
    return 0;
}

} // namespace stromboli
