// Options: how many samples, where they go, and when it is enough.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/render/noise_plan.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

constexpr Range<uint32_t> kSamples{1, kMostSamples};
/// A sample is the least work a lane takes on: more would leave lanes without work at the end.
constexpr Range<uint32_t> kBranches{1, 64};
constexpr Range<uint32_t> kAnySeed{0, 0xFFFFFFFFu};
constexpr Range<uint32_t> kSampleNumbers{0, kMostSamples - 1};
constexpr Range<double> kTolerance{0, 1e6};
constexpr Range<double> kNoise{1e-6, 1e6}; // a float has no more digits
constexpr Range<double> kSeconds{0.01, 1e9};
const char* const kBothSpread = "both say where samples go";

void checkBranches(const DeclaredCommand& c) {
    const Options& o = c.options;
    const uint32_t paths = o.budget.pathsPerPixel(), branches = o.branches.value_or(1);
    if ((c.asked.paths || !o.budget.stop.open()) && paths % branches != 0)
        throw UsageError(fmt::format("-s {} is not a multiple of --branches {}", paths, branches));
    if (branches > 1 && o.budget.adaptive.enabled)
        throw UsageError(
            "--branches does not go with -a, which counts paths and which --cs184 switches on");
}

} // namespace

void declareSamples(DeclaredCommand& c, const std::string& samplesHelp) {
    c.list.group("Sampling");
    c.list.number("-s,--samples", "N", samplesHelp, c.asked.paths, kSamples)
        .usually(fmt::format("{}{}", c.asked.usualPaths,
                             rendersPictures(c.options.command) ? "; --cs184: 1" : ""));
    declareSampler(c, c.options.estimator.sampler);
    c.list.choice("--filter", "WHICH", "how much places about a pixel count for it",
                  c.options.estimator.filter);
    c.list.number("--seed", "N", "another seed, another noise", c.options.estimator.seed, kAnySeed);
}

void declareBranches(DeclaredCommand& c, const std::string& usually) {
    c.list.group("Sampling");
    c.list
        .number("--branches", "K",
                "paths that share a camera ray and the light samples where it ends; -s, which "
                "counts paths, is a multiple of it",
                c.options.branches, kBranches)
        .usually(usually);
}

CommandOption& declareBlock(DeclaredCommand& c) {
    return c.list.number(
        "--block", "N",
        "paths of a pixel that are added up by themselves, where all pixels get as many; shares "
        "consist of whole blocks, and renders of other blocks differ in the last bits "
        "(docs/farm.md)",
        c.asked.pathsPerBlock, kSamples);
}

CommandOption& declareNoise(DeclaredCommand& c, const std::string& help, double& where) {
    return c.list.real("--noise", "T", help, where, kNoise).usually("");
}

void declareSpreading(DeclaredCommand& c) {
    OptionList& list = c.list;
    Adaptive& a = c.options.budget.adaptive;
    list.group("Sampling");
    list.flag("--even",
              "the same number of samples for every pixel, so that a --crop has the bytes it has "
              "in the whole picture",
              c.asked.even);
    declareBlock(c).needs("--even");
    list.words("-a,--adaptive", "BATCH TOLERANCE",
               "adaptive sampling: test a pixel every BATCH samples, stop at 1.96 sigma <= "
               "TOLERANCE * mean",
               2,
               [&c, &a](const Words& words) {
                   c.asked.adaptive = true;
                   a.batch = readNumber("-a: BATCH", words[0], kSamples);
                   a.tolerance = readReal("-a: TOLERANCE", words[1], kTolerance);
               })
        .from(fmt::format("{} and {}", inWords(kSamples), inWords(kTolerance)))
        .usually(fmt::format("off; --cs184: {} {}", a.batch, a.tolerance))
        .excludes("--even", kBothSpread);
    declareNoise(c,
                 "go on until the picture's noise, the square root of its relMSE, is at most T "
                 "(0.02: 2 %) in 95 of 100 renders; samples go where they help most; -s is the "
                 "most per pixel",
                 c.options.budget.stop.noise)
        .excludes("-a", kBothSpread)
        .excludes("--even", kBothSpread);
    list.real(
            "--time", "S",
            "take samples for at most S seconds, from a coarse grid of pixels to all of them, then "
            "where they help most; loading, preparing and writing are not counted; -s is the most "
            "per pixel",
            c.options.budget.stop.seconds, kSeconds)
        .usually("")
        .excludes("-a", kBothSpread)
        .excludes("--even", kBothSpread);
}

void finishBudget(DeclaredCommand& c, bool maySpread) {
    Options& o = c.options;
    PathBudget& b = o.budget;
    if (c.asked.sampleAlone) o.sampleAlone = c.asked.sample;
    b.mostPathsPerPixel = c.asked.paths.value_or(c.asked.usualPaths);
    // --cs184 turns it on: for paths, where nothing else is asked for.
    if (o.estimator.integrator != Integrator::Path || c.asked.even || b.stop.open())
        b.adaptive.enabled = false;
    if (c.asked.adaptive) b.adaptive.enabled = true;
    if (b.stop.open() && !c.asked.paths) b.mostPathsPerPixel.reset();
    if (c.asked.even) b.pathsPerBlock = c.asked.pathsPerBlock;
    if (!o.branches && !maySpread && o.command != Command::Info) o.branches = 1;
    if (o.branches) checkBranches(c);

    // Samples go where they help most unless something else is asked for. With as few as the
    // first, uniform pass takes there is nothing to spread.
    const bool asked =
        c.asked.even || b.adaptive.enabled || b.stop.open() || o.sampleAlone.has_value();
    if (!maySpread || !c.asked.usuallySpread || asked ||
        b.pathsPerPixel() <= NoisePlan::kFirstPaths)
        return;
    b.meanPathsPerPixel = b.pathsPerPixel();
    b.mostPathsPerPixel.reset();
}

/// As a line about rejected samples names one: added to the same command, they show it again.
void declareSampleAlone(DeclaredCommand& c) {
    c.list.group("Sampling");
    SampleName& name = c.asked.sample;
    c.list
        .numbers("--pixel", "X Y",
                 "with --sample: no picture, only print the radiance of one sample of this pixel "
                 "(column, row from the top)",
                 {&name.x, &name.y}, {0, 65535})
        .needs("--sample");
    c.list
        .words("--sample", "N", "the sample's number, the first being 0", 1,
               [&c, &name](const Words& words) {
                   name.sample = readNumber("--sample", words[0], kSampleNumbers);
                   c.asked.sampleAlone = true;
               })
        .from(inWords(kSampleNumbers))
        .needs("--pixel");
}

} // namespace stromboli
