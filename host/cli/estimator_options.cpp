// Options: what is estimated and how, how many samples, where they go and when it is enough; which
// device takes them.
#include "host/cli/cs184_options.hpp"
#include "host/core/error.hpp"
#include "host/render/sampling_plan.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

constexpr Range<uint32_t> kLightSamples{1, 1024};
constexpr Range<uint32_t> kBounces{0, 10000};

/// none, throughput, or the probability of ending a path.
Roulette readRoulette(const std::string& word) {
    if (word == "none") return {Roulette::Mode::None};
    if (word == "throughput") return {Roulette::Mode::Throughput};
    try {
        const double p = readReal("--roulette", word, {0, 1});
        if (p < 1) return {Roulette::Mode::Fixed, p};
    } catch (const UsageError&) { // the message below names all there is
    }
    throw UsageError(fmt::format(
        "--roulette is '{}': expected none, throughput or a probability in [0, 1)", word));
}

/// Which light a light sample takes is no question where each is sampled in turn, and without
/// samples of emitters a question of lights that no direction meets.
void remarkOnLightChoice(DeclaredCommand& c, const Estimator& e, BackendChoice backend,
                         const std::string& conventions) {
    if (!c.has("--light-choice") || e.integrator != Integrator::Path) return;
    std::vector<std::string>& remarks = c.host.remarks;
    if (e.conventions.everyLightInTurn)
        remarks.push_back(
            fmt::format("{} samples every light in turn: ignored: --light-choice", conventions));
    else if (backend == BackendChoice::Reference)
        remarks.emplace_back("the reference samples every light in turn: ignored: --light-choice");
    else if (!samplesLights(e.directLight))
        remarks.push_back(fmt::format("--direct {} finds what shines by directions: --light-choice "
                                      "is heeded among point, spot and directional lights alone",
                                      nameOf(e.directLight)));
}

constexpr Range<uint32_t> kSamples{1, kMostSamples};
/// A sample is the least work a lane takes on: more would leave lanes without work at the end.
constexpr Range<uint32_t> kBranches{1, 64};
constexpr Range<uint32_t> kAnySeed{0, 0xFFFFFFFFu};
constexpr Range<uint32_t> kSampleNumbers{0, kMostSamples - 1};
constexpr Range<double> kTolerance{0, 1e6};
constexpr Range<double> kNoise{1e-6, 1e6}; // a float has no more digits
constexpr Range<double> kSeconds{0.01, 1e9};
constexpr Range<double> kMemory{1, 1e7};
const char* const kBothSpread = "both say where samples go";

void checkBranches(const RenderRequest& picture, const Asked& asked) {
    const PathBudget& budget = picture.budget;
    const uint32_t paths = budget.pathsPerPixel(), branches = picture.branches.value_or(1);
    if ((asked.paths || !budget.stop.open()) && paths % branches != 0)
        throw UsageError(fmt::format("-s {} is not a multiple of --branches {}", paths, branches));
    if (branches > 1 && budget.adaptive.enabled)
        throw UsageError(
            "--branches does not go with -a, which counts paths and which other conventions may "
            "switch on");
}

} // namespace

void declareEstimator(OptionList& list, SceneAndPicture& work, Asked& asked) {
    Estimator& e = work.picture.estimator;
    list.group("Light");
    list.number("-m,--max-bounces", "N", "scatterings of light at most; 0: emission only",
                e.maxBounces, kBounces);
    list.number("--min-bounce", "K",
                "leave out light scattered fewer times; equal to -m: that bounce alone",
                e.minBounce, kBounces);
    list.number("-l,--light-samples", "N", "samples of lights per shading point", e.lightSamples,
                kLightSamples);
    list.choice("--direct", "HOW", "how lights are found from a surface", e.directLight);
    list.flag("-H", "same as --direct hemisphere",
              [&e] { e.directLight = DirectLight::Hemisphere; })
        .excludes("--direct", "both say how lights are found");
    list.choice("--light-choice", "HOW", "which of several lights a light sample takes",
                e.lightChoice);
    list.words("--roulette", "MODE",
               "none, throughput (from bounce 3 on), or a probability P of ending a path at every "
               "hit",
               1, [&e](const Words& words) { e.roulette = readRoulette(words[0]); })
        .usually("throughput")
        .proposes({"none", "throughput"})
        .from("0 to 1, without 1");
    list.onOff(
        "--gap-proposal",
        "on: some bounces go into the bright gap between a light and a surface close to it, or "
        "into shades of lamps; off: all as the materials scatter",
        e.gapProposal);
    list.onOff("--terminator-offset",
               "on: meshes with normals of their own reflect light from the smooth surface that "
               "these describe; off: from their flat triangles, as most renderers have it",
               e.conventions.offsetsTerminator);
    list.choice("--integrator", "KIND", "what a sample is", e.integrator);
    declareCs184(list, work, asked);
}

void finishEstimator(DeclaredCommand& c, SceneAndPicture& work, const Asked& asked) {
    Estimator& e = work.picture.estimator;
    const BackendChoice backend = work.device.backend;
    const SceneConventions& reading = work.scene.reading;
    const bool isUsual = reading.areDefault();
    work.picture.leftToFile = {.bounces = !c.has("-m") && !c.has("--min-bounce") && isUsual,
                               .filter = !c.has("--filter") && isUsual,
                               .integrator = !c.has("--integrator")};
    if (asked.accumulate && *asked.accumulate == 0) e.minBounce = e.maxBounces;
    const std::string moot =
        e.integrator != Integrator::Path
            ? c.givenOf({"-m", "--min-bounce", "-l", "--direct", "-H", "--light-choice",
                         "--roulette", "--gap-proposal", "--guiding", "--portals",
                         "--terminator-offset", "--branches", "-a", "--clamp-indirect"})
            : "";
    if (!moot.empty())
        c.host.remarks.push_back(fmt::format("--integrator {} follows no light: ignored: {}",
                                             nameOf(e.integrator), moot));
    remarkOnLightChoice(c, e, backend, reading.option);
    if (work.picture.guiding == Guiding::On && backend == BackendChoice::Reference)
        c.host.remarks.emplace_back("the reference guides no light samples: --guiding ignored");
    if (work.picture.guiding == Guiding::On && !samplesLights(e.directLight))
        throw UsageError(fmt::format("--guiding on needs lights that are sampled: not --direct {}",
                                     nameOf(e.directLight)));
    if (work.picture.portals == PortalUse::On && backend == BackendChoice::Reference)
        c.host.remarks.emplace_back("the reference aims at no portals: --portals ignored");
    if (work.picture.portals == PortalUse::On && !samplesLights(e.directLight))
        throw UsageError(fmt::format("--portals on needs lights that are sampled: not --direct {}",
                                     nameOf(e.directLight)));
    if (c.has("--gap-proposal") && e.gapProposal && backend == BackendChoice::Reference)
        c.host.remarks.emplace_back("the reference makes no gap proposal: --gap-proposal ignored");
    if (c.has("--gap-proposal") && e.gapProposal && !samplesLights(e.directLight))
        throw UsageError(
            fmt::format("--gap-proposal on needs lights that are sampled: not --direct {}",
                        nameOf(e.directLight)));
    if (e.conventions.offsetsTerminator && !e.conventions.facesForward)
        throw UsageError(fmt::format(
            "--terminator-offset on does not go with {}, whose surfaces are flat", reading.option));
    if (e.minBounce > e.maxBounces)
        throw UsageError(fmt::format("--min-bounce {} is more than -m {}: no light is left",
                                     e.minBounce, e.maxBounces));
}

void declareSampler(OptionList& list, Sampler& where) {
    list.group("Sampling");
    list.choice("--sampler", "WHICH", "where random numbers come from", where);
}

void declareSamples(OptionList& list, RenderRequest& picture, Asked& asked,
                    const std::string& samplesHelp) {
    Estimator& e = picture.estimator;
    list.group("Sampling");
    list.number("-s,--samples", "N", samplesHelp, asked.paths, kSamples)
        .usually(fmt::format("{}", asked.usualPaths));
    declareSampler(list, e.sampler);
    list.choice("--filter", "WHICH", "how much places about a pixel count for it", e.filter);
    list.number("--seed", "N", "another seed, another noise", e.seed, kAnySeed);
}

void declareClamp(OptionList& list, RenderRequest& picture) {
    list.group("Sampling");
    list.real("--clamp-indirect", "X",
              "limit what light brings at a time that was scattered twice or more to X in its "
              "brightest channel: fewer fireflies, but light is missing: the picture is biased",
              picture.estimator.indirectLimit, {1e-6, 1e30})
        .usually("off");
}

void declareBranches(OptionList& list, RenderRequest& picture, const std::string& usually) {
    list.group("Sampling");
    list.choice("--guiding", "WHEN",
                "light samples go to the parts of an environment that are seen from where they "
                "are taken, which is learnt before the picture begins, unless it gains little",
                picture.guiding);
    list.choice("--portals", "WHEN",
                "light samples to the sky aim at the openings that a room sees it through: those "
                "of --portal, or of the file, or else those that are found, unless that gains "
                "little",
                picture.portals);
    list.number("--branches", "K",
                "paths that share a camera ray and the light samples where it ends; -s, which "
                "counts paths, is a multiple of it",
                picture.branches, kBranches)
        .usually(usually);
}

CommandOption& declareBlock(OptionList& list, Asked& asked) {
    return list.number(
        "--block", "N",
        "paths of a pixel that are added up by themselves, where all pixels get as many; shares "
        "consist of whole blocks, and renders of other blocks differ in the last bits "
        "(docs/guide/farm.md)",
        asked.pathsPerBlock, kSamples);
}

CommandOption& declareNoise(OptionList& list, const std::string& help, double& where) {
    return list.real("--noise", "T", help, where, kNoise, kShares).usually("");
}

void declareSpreading(OptionList& list, RenderRequest& picture, Asked& asked) {
    Adaptive& a = picture.budget.adaptive;
    StopRule& stop = picture.budget.stop;
    list.group("Sampling");
    list.flag("--even",
              "the same number of samples for every pixel, so that a --crop has the bytes it has "
              "in the whole picture",
              asked.even);
    declareBlock(list, asked).needs("--even");
    list.words("-a,--adaptive", "BATCH TOLERANCE",
               "adaptive sampling: test a pixel every BATCH samples, stop at 1.96 sigma <= "
               "TOLERANCE * mean",
               2,
               [&asked, &a](const Words& words) {
                   asked.adaptive = true;
                   a.batch = readNumber("-a: BATCH", words[0], kSamples);
                   a.tolerance = readReal("-a: TOLERANCE", words[1], kTolerance, kShares);
               })
        .from(fmt::format("{} and {}", inWords(kSamples), inWords(kTolerance)))
        .usually("off")
        .excludes("--even", kBothSpread);
    declareNoise(list,
                 "go on until the picture's noise, the square root of its relMSE, is at most T "
                 "(0.02 or 2%) in 95 of 100 renders; samples go where they help most; -s is the "
                 "most per pixel",
                 stop.noise)
        .excludes("-a", kBothSpread)
        .excludes("--even", kBothSpread);
    list.real(
            "--time", "S",
            "take samples for at most S seconds (90, 10s, 2m, 1h30m), from a coarse grid of pixels "
            "to all of them, then "
            "where they help most; loading, preparing and writing are not counted; -s is the most "
            "per pixel",
            stop.seconds, kSeconds, kTimes)
        .usually("")
        .excludes("-a", kBothSpread)
        .excludes("--even", kBothSpread);
}

void finishBudget(RenderRequest& picture, const Asked& asked) {
    PathBudget& b = picture.budget;
    b.mostPathsPerPixel = asked.paths.value_or(asked.usualPaths);
    // Conventions may turn it on: for paths, where nothing else is asked for.
    if (picture.estimator.integrator != Integrator::Path || asked.even || b.stop.open())
        b.adaptive.enabled = false;
    if (asked.adaptive) b.adaptive.enabled = true;
    if (b.stop.open() && !asked.paths) b.mostPathsPerPixel.reset();
    if (asked.even) b.pathsPerBlock = asked.pathsPerBlock;
    if (!picture.branches && !asked.branchesPay) picture.branches = 1;
    if (picture.branches) checkBranches(picture, asked);

    // Samples go where they help most unless something else is asked for. With as few as the
    // first, uniform pass takes there is nothing to spread.
    const bool isSpreadOtherwise =
        asked.even || b.adaptive.enabled || b.stop.open() || asked.pixelAlone;
    if (!asked.maySpread || !asked.usuallySpread || isSpreadOtherwise ||
        b.pathsPerPixel() <= NoisePlan::kFirstPaths)
        return;
    b.meanPathsPerPixel = b.pathsPerPixel();
    b.mostPathsPerPixel.reset();
}

void declareFilmMemory(OptionList& list, DeviceRequest& device) {
    list.group("Device");
    list.number("--film-memory", "MIB",
                "mebibytes for the film and what belongs to it; a picture that needs more is "
                "rendered in bands",
                device.filmMebibytes, {1, 1u << 30})
        .usually("half of the machine's memory")
        .besidePicture();
    list.real("--max-memory", "M",
              "mebibytes (2000, 2GiB) for the whole process, by an estimate before the first "
              "sample: a picture that needs more is rendered in bands, a scene that does is an "
              "error",
              device.mostMebibytes, kMemory, kMebibytes)
        .usually("no limit")
        .besidePicture();
}

void declareDevice(OptionList& list, std::string& device) {
    list.group("Device");
    list.text("--device", "D",
              "number, UUID or part of a name from 'stromboli devices', or cpu; of 'render' also "
              "several, with commas between them, or all",
              device)
        .usually("the best")
        .besidePicture()
        .proposes({"cpu", "all"});
}

void declareHost(DeclaredCommand& c) {
    HostOptions& o = c.host;
    c.list.group("Device");
    c.list
        .number("-t,--threads", "N", "host threads (BVH, reference, tone mapping); 0: all",
                o.threads, {0, 65536})
        .usually("all")
        .besidePicture();
    c.list.group("Messages");
    c.list.flag("-q,--quiet", "warnings and errors only", [&o] { o.verbosity = Verbosity::Quiet; })
        .besidePicture();
    c.list.flag("-v,--verbose", "more detail", [&o] { o.verbosity = Verbosity::Verbose; })
        .besidePicture()
        .excludes("-q");
}

} // namespace stromboli
