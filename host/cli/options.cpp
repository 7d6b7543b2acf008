#include "host/cli/options.hpp"

#include "host/cli/cs184_spelling.hpp"
#include "host/cli/declare_options.hpp"
#include "host/core/error.hpp"
#include "host/render/noise_plan.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace stromboli {
namespace {

/// Larger pictures than this on a side are taken for mistakes.
constexpr uint32_t kLargestSide = 65536;
/// Sample counts are exact up to this (24-bit floats in the running mean).
constexpr uint32_t kMostSamples = 1u << 24;
/// A sample is the least work a lane takes on: more would leave lanes without work at the end.
constexpr uint32_t kMostBranches = 64;
constexpr uint32_t kMostLightSamples = 1024;
constexpr uint32_t kMostBounces = 10000;

void checkRange(const char* what, double value, double least, double most) {
    if (!(value >= least && value <= most))
        throw UsageError(fmt::format("{} is {}: expected {} to {}", what, value, least, most));
}

void applySize(const RawOptions& raw, Options& o) {
    if (raw.size.empty()) return;
    checkRange("-r: width", raw.size[0], 1, kLargestSide);
    checkRange("-r: height", raw.size[1], 1, kLargestSide);
    o.settings.width = raw.size[0];
    o.settings.height = raw.size[1];
    o.sizeGiven = true;
}

/// The crop is checked against the picture once its size is known (job.cpp); here its own sense.
void applyCrop(const RawOptions& raw, Options& o) {
    const std::vector<uint32_t>& c = raw.crop.empty() ? raw.cell : raw.crop;
    if (c.empty()) return;
    if (!raw.crop.empty() && !raw.cell.empty())
        throw UsageError("--crop and -p (--cell) exclude each other");
    if (c[2] == 0 || c[3] == 0) throw UsageError("--crop: width and height must be at least 1");
    o.settings.crop = {c[0], c[1], c[2], c[3]};
    if (raw.crop.empty()) {
        if (!o.sizeGiven) o.settings.width = 800, o.settings.height = 600, o.sizeGiven = true;
        if (uint64_t(c[1]) + c[3] > o.settings.height)
            throw UsageError(fmt::format("-p: the cell ends at row {} of {}", uint64_t(c[1]) + c[3],
                                         o.settings.height));
        o.settings.crop.y = o.settings.height - c[1] - c[3];
    }
}

Roulette parseRoulette(const std::string& text, bool cs184) {
    Roulette r;
    if (text.empty()) {
        r.mode = cs184 ? Roulette::Mode::None : Roulette::Mode::Throughput;
    } else if (text == "none") {
        r.mode = Roulette::Mode::None;
    } else if (text != "throughput") {
        char* end = nullptr;
        r.mode = Roulette::Mode::Fixed;
        r.terminationProbability = std::strtod(text.c_str(), &end);
        if (*end != 0 || !(r.terminationProbability >= 0 && r.terminationProbability < 1))
            throw UsageError(fmt::format("--roulette is '{}': expected none, throughput or a "
                                         "probability in [0, 1)",
                                         text));
    }
    return r;
}

void applySampleAlone(const RawOptions& raw, Options& o) {
    if (!raw.sample) return;
    checkRange("--sample", *raw.sample, 0, kMostSamples - 1);
    o.sampleAlone = {raw.pixel[0], raw.pixel[1], *raw.sample};
}

void applyAdaptive(const RawOptions& raw, Options& o) {
    Adaptive& a = o.settings.adaptive;
    a.enabled = o.settings.cs184 && o.settings.integrator == Integrator::Path;
    if (raw.adaptive.empty()) return;
    a.enabled = true;
    checkRange("-a: BATCH", raw.adaptive[0], 1, kMostSamples);
    if (raw.adaptive[0] != std::floor(raw.adaptive[0]))
        throw UsageError("-a: BATCH must be a whole number");
    checkRange("-a: TOLERANCE", raw.adaptive[1], 0, 1e6);
    a.batch = uint32_t(raw.adaptive[0]);
    a.tolerance = raw.adaptive[1];
}

void applyStopRule(const RawOptions& raw, Options& o) {
    StopRule& stop = o.settings.stop;
    if (raw.noise) {
        checkRange("--noise", *raw.noise, 1e-6, 1e6); // a float has no more digits
        stop.noise = *raw.noise;
    }
    if (raw.seconds) {
        checkRange("--time", *raw.seconds, 0.01, 1e9);
        stop.seconds = *raw.seconds;
    }
    if (!stop.open()) return;
    const char* name = raw.noise ? "--noise" : "--time";
    if (!raw.adaptive.empty())
        throw UsageError(
            fmt::format("{} and -a exclude each other: both say where samples go", name));
    if (raw.even)
        throw UsageError(
            fmt::format("{} and --even exclude each other: both say where samples go", name));
    o.settings.adaptive.enabled = false; // --cs184 turns it on
    if (!raw.samples) o.settings.samplesPerPixel = kMostSamples;
}

/// Samples go where they help most unless something else is asked for. With as few as the first,
/// uniform pass takes there is nothing to spread.
void spreadSamples(const RawOptions& raw, Options& o) {
    RenderSettings& s = o.settings;
    if (raw.even && !raw.adaptive.empty())
        throw UsageError("-a and --even exclude each other: both say where samples go");
    if (raw.even) s.adaptive.enabled = false; // --cs184 turns it on
    if (raw.even || s.cs184 || s.adaptive.enabled || s.stop.open() || o.sampleAlone) return;
    if (s.samplesPerPixel <= NoisePlan::kFirstPaths) return;
    s.stop.meanSamples = s.samplesPerPixel;
    s.samplesPerPixel = kMostSamples;
}

void applyBranches(const RawOptions& raw, Options& o) {
    const bool chooses = o.command == Command::Render || o.command == Command::Info;
    if (!chooses) o.branches = 1;
    if (!raw.branches) return;
    const uint32_t paths = o.settings.samplesPerPixel;
    o.branches = *raw.branches;
    checkRange("--branches", *o.branches, 1, kMostBranches);
    if ((raw.samples || !o.settings.stop.open()) && paths % *o.branches != 0)
        throw UsageError(
            fmt::format("-s {} is not a multiple of --branches {}", paths, *o.branches));
    if (*o.branches > 1 && (o.settings.cs184 || o.settings.adaptive.enabled))
        throw UsageError("--branches does not go with -a and --cs184, which count paths");
}

void applyLight(const RawOptions& raw, Options& o) {
    RenderSettings& s = o.settings;
    s.samplesPerPixel = raw.samples.value_or(s.cs184 ? 1 : s.samplesPerPixel);
    checkRange("-s", s.samplesPerPixel, 1, kMostSamples);
    s.lightSamples = raw.lightSamples.value_or(1);
    checkRange("-l", s.lightSamples, 1, kMostLightSamples);
    s.maxBounces = raw.maxBounces.value_or(s.cs184 ? 1 : s.maxBounces);
    checkRange("-m", s.maxBounces, 0, kMostBounces);
    s.minBounce = raw.minBounce.value_or(0);
    if (raw.accumulate && *raw.accumulate == 0) s.minBounce = s.maxBounces;
    if (s.minBounce > s.maxBounces)
        throw UsageError(fmt::format("--min-bounce {} is more than -m {}: no light is left",
                                     s.minBounce, s.maxBounces));
    s.integrator = raw.integrator == "normals" ? Integrator::Normals : Integrator::Path;
    if (raw.hemisphere && raw.direct == "bsdf")
        throw UsageError("-H and --direct bsdf exclude each other");
    s.directLight = raw.hemisphere || raw.direct == "hemisphere" ? DirectLight::Hemisphere
                    : raw.direct == "bsdf"                       ? DirectLight::Bsdf
                    : raw.direct == "lights"                     ? DirectLight::Lights
                                                                 : DirectLight::Mis;
    const bool sobol = raw.sampler.empty() ? !s.cs184 : raw.sampler == "sobol";
    s.guides = raw.guide == "on";
    s.lightChoice = raw.lightChoice == "tree"    ? LightChoice::Tree
                    : raw.lightChoice == "power" ? LightChoice::Power
                                                 : LightChoice::Uniform;
    s.sampler = sobol ? Sampler::Sobol : Sampler::Independent;
    s.roulette = parseRoulette(raw.roulette, s.cs184);
}

void apply(const RawOptions& raw, Options& o) {
    if (raw.quiet && raw.verbose) throw UsageError("-q and -v exclude each other");
    o.verbosity = raw.quiet     ? Verbosity::Quiet
                  : raw.verbose ? Verbosity::Verbose
                                : Verbosity::Normal;
    o.camera = raw.camera == "file"    ? CameraChoice::File
               : raw.camera == "frame" ? CameraChoice::Frame
                                       : CameraChoice::Automatic;
    o.backend = raw.backend == "reference" ? BackendChoice::Reference : BackendChoice::Vulkan;
    checkRange("--exposure", o.exposure, -100, 100);
    applySize(raw, o);
    applyCrop(raw, o);
    applyLight(raw, o);
    applyAdaptive(raw, o);
    applyStopRule(raw, o);
    applySampleAlone(raw, o);
}

Command commandOf(const Subcommands& commands) {
    if (*commands.render) return Command::Render;
    if (*commands.check) return Command::Check;
    if (*commands.info) return Command::Info;
    if (*commands.bench) return Command::Bench;
    if (*commands.compare) return Command::Compare;
    if (*commands.study) return Command::Study;
    if (*commands.stress) return Command::Stress;
    return Command::Devices;
}

} // namespace

std::optional<Options> parseOptions(std::vector<std::string> arguments) {
    Options o;
    RawOptions raw;
    CLI::App app;
    const Subcommands commands = declareOptions(app, raw, o);
    try {
        arguments = fromCs184Spelling(std::move(arguments));
        std::reverse(arguments.begin(), arguments.end()); // CLI11 takes them from the back
        app.parse(arguments);
    } catch (const CLI::Success& done) { // --help, --version
        app.exit(done);
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        throw UsageError(std::string(error.what()) + " (see --help)");
    }
    o.command = commandOf(commands);
    if (*commands.check) { // a quick, small picture unless asked otherwise
        if (raw.size.empty()) raw.size = {160, 120};
        if (!raw.samples) raw.samples = 256;
    }
    if (*commands.bench) applyBenchDefaults(raw);
    apply(raw, o);
    applyBranches(raw, o);
    if (*commands.render) spreadSamples(raw, o);
    if (*commands.bench) applyBench(raw.bench, o);
    if (*commands.study) applyStudy(raw.study, o.study);
    if (*commands.render && o.output.empty() && !o.sampleAlone)
        throw UsageError("--output is required (see --help)");
    if (*commands.check) o.settings.adaptive.enabled = false; // a z-test needs fixed sample counts
    return o;
}

} // namespace stromboli
