// Options: what is estimated, and how.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"

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

/// That renderer's conventions, each by its name, and its defaults. What is below the command line
/// knows of the conventions and not of the option.
void useCs184(DeclaredCommand& c) {
    Options& o = c.options;
    o.reading = cs184Conventions();
    o.framing = cs184Framing();
    o.estimator.conventions = cs184Shading();
    o.tone.kind = ToneCurve::Kind::Cs184;
    o.budget.adaptive.rule = Adaptive::Rule::PerChannel;

    o.estimator.maxBounces = 1;
    o.estimator.sampler = Sampler::Independent;
    o.estimator.roulette.mode = Roulette::Mode::None;
    o.branches = 1;
    o.budget.adaptive.enabled = true;
    if (rendersPictures(o.command)) c.asked.usualPaths = 1; // one sample checks nothing
    c.asked.usuallySpread = false;
}

/// Which light a light sample takes is no question where each is sampled in turn, and without
/// samples of emitters a question of lights that no direction meets.
void remarkOnLightChoice(DeclaredCommand& c) {
    const Estimator& e = c.options.estimator;
    if (!c.has("--light-choice") || e.integrator != Integrator::Path) return;
    std::vector<std::string>& remarks = c.options.remarks;
    if (e.conventions.everyLightInTurn)
        remarks.emplace_back("--cs184 samples every light in turn: ignored: --light-choice");
    else if (c.options.backend == BackendChoice::Reference)
        remarks.emplace_back("the reference samples every light in turn: ignored: --light-choice");
    else if (!samplesLights(e.directLight))
        remarks.push_back(fmt::format("--direct {} finds what shines by directions: --light-choice "
                                      "is heeded among point, spot and directional lights alone",
                                      nameOf(e.directLight)));
}

} // namespace

void declareEstimator(DeclaredCommand& c) {
    Estimator& e = c.options.estimator;
    OptionList& list = c.list;
    list.group("Light");
    list.number("-m,--max-bounces", "N", "scatterings of light at most; 0: emission only",
                e.maxBounces, kBounces)
        .usually(fmt::format("{}; --cs184: 1", e.maxBounces));
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
        .usually("throughput; --cs184: none")
        .proposes({"none", "throughput"})
        .from("0 to 1, without 1");
    list.onOff("--gap-proposal",
               "on: some bounces go into the bright gap between a light and a surface close to it; "
               "off: all as the materials scatter",
               e.gapProposal);
    list.onOff("--terminator-offset",
               "on: meshes with normals of their own reflect light from the smooth surface that "
               "these describe; off: from their flat triangles, as most renderers have it",
               e.conventions.offsetsTerminator)
        .usually("on; --cs184: off");
    list.choice("--integrator", "KIND", "what a sample is", e.integrator);
    list.flag("--cs184",
              "the CS184 renderer's conventions: framing and crop, normals, lights, tone curve, "
              "adaptive sampling by default (docs/cs184.md)",
              [&c] { useCs184(c); })
        .changesDefaults();
}

void finishEstimator(DeclaredCommand& c) {
    Estimator& e = c.options.estimator;
    c.options.bouncesGiven = c.has("-m") || c.has("--min-bounce") || c.has("--cs184");
    c.options.filterGiven = c.has("--filter") || c.has("--cs184");
    c.options.integratorGiven = c.has("--integrator");
    if (c.asked.accumulate && *c.asked.accumulate == 0) e.minBounce = e.maxBounces;
    const std::string moot =
        e.integrator != Integrator::Path
            ? c.givenOf({"-m", "--min-bounce", "-l", "--direct", "-H", "--light-choice",
                         "--roulette", "--gap-proposal", "--terminator-offset", "--branches", "-a"})
            : "";
    if (!moot.empty())
        c.options.remarks.push_back(fmt::format("--integrator {} follows no light: ignored: {}",
                                                nameOf(e.integrator), moot));
    remarkOnLightChoice(c);
    if (c.has("--gap-proposal") && e.gapProposal && c.options.backend == BackendChoice::Reference)
        c.options.remarks.emplace_back(
            "the reference makes no gap proposal: --gap-proposal ignored");
    if (c.has("--gap-proposal") && e.gapProposal && !samplesLights(e.directLight))
        throw UsageError(
            fmt::format("--gap-proposal on needs lights that are sampled: not --direct {}",
                        nameOf(e.directLight)));
    if (e.conventions.offsetsTerminator && !e.conventions.facesForward)
        throw UsageError(
            "--terminator-offset on does not go with --cs184, whose surfaces are flat");
    if (e.minBounce > e.maxBounces)
        throw UsageError(fmt::format("--min-bounce {} is more than -m {}: no light is left",
                                     e.minBounce, e.maxBounces));
}

void declareSampler(DeclaredCommand& c, Sampler& where) {
    c.list.group("Sampling");
    c.list.choice("--sampler", "WHICH", "where random numbers come from", where)
        .usually(fmt::format("{}; --cs184: independent", nameOf(where)));
}

} // namespace stromboli
