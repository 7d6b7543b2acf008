#include "host/cli/options.hpp"

#include "host/cli/cs184_spelling.hpp"
#include "host/core/error.hpp"

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
constexpr uint32_t kMostLightSamples = 1024;
constexpr uint32_t kMostBounces = 10000;

/// What is parsed as text or lists before it is checked.
struct Raw {
    std::vector<uint32_t> size, crop, cell;
    std::vector<double> adaptive;
    std::string roulette, integrator = "path", direct = "lights", camera = "auto",
                          backend = "vulkan";
    std::optional<uint32_t> samples, lightSamples, maxBounces, minBounce, accumulate;
    bool hemisphere = false, quiet = false, verbose = false;
};

void addScene(CLI::App& app, Options& o) {
    app.add_option("SCENE", o.scene, "COLLADA file (.dae)")->required()->group("Scene");
}

void addPicture(CLI::App& app, Raw& raw,
                const char* sizeHelp = "picture size [the camera's shape, 800 wide]") {
    app.add_option("-r,--size", raw.size, sizeHelp)
        ->expected(2)
        ->allow_extra_args(false)
        ->type_name("W H")
        ->group("Picture");
    app.add_option("--camera", raw.camera,
                   "auto, file or frame: the file's camera, or one that frames the scene as the "
                   "CS184 renderer does (auto: frame for its dialect and for files without one)")
        ->check(CLI::IsMember({"auto", "file", "frame"}))
        ->default_str("auto")
        ->type_name("WHICH")
        ->group("Picture");
    app.add_option("--crop", raw.crop, "only this part: left, top, width, height in pixels")
        ->expected(4)
        ->allow_extra_args(false)
        ->type_name("X Y W H")
        ->group("Picture");
    app.add_option("--cell", raw.cell, "the same with Y from the bottom (CS184's -p)")
        ->expected(4)
        ->allow_extra_args(false)
        ->type_name("X Y W H")
        ->group("Picture");
}

void addLightTransport(CLI::App& app, Raw& raw, Options& o) {
    app.add_option("-m,--max-bounces", raw.maxBounces,
                   "scatterings of light at most; 0: lamps only [8; --cs184: 1]")
        ->type_name("N")
        ->group("Light");
    app.add_option("--min-bounce", raw.minBounce,
                   "leave out light scattered fewer times [0]; equal to -m: that bounce alone")
        ->type_name("K")
        ->group("Light");
    app.add_option("-l,--light-samples", raw.lightSamples,
                   "samples per shading point and area light [1]")
        ->type_name("N")
        ->group("Light");
    app.add_option("--direct", raw.direct,
                   "lights, hemisphere or bsdf: how lamps are found from a surface")
        ->check(CLI::IsMember({"lights", "hemisphere", "bsdf"}))
        ->default_str("lights")
        ->type_name("HOW")
        ->group("Light");
    app.add_flag("-H", raw.hemisphere, "same as --direct hemisphere")->group("Light");
    app.add_option("--roulette", raw.roulette,
                   "none, throughput (from bounce 3 on), or a probability P of ending a path at "
                   "every hit [throughput; --cs184: none]")
        ->type_name("MODE")
        ->group("Light");
    app.add_option("--integrator", raw.integrator, "path or normals")
        ->check(CLI::IsMember({"path", "normals"}))
        ->default_str("path")
        ->type_name("KIND")
        ->group("Light");
    app.add_flag("--cs184", o.settings.cs184,
                 "the CS184 renderer's conventions: framing and crop, normals, lights, tone curve, "
                 "adaptive sampling by default (docs/cs184.md)")
        ->group("Light");
}

void addSampling(CLI::App& app, Raw& raw, Options& o, const char* samplesHelp) {
    app.add_option("-s,--samples", raw.samples, samplesHelp)->type_name("N")->group("Sampling");
    app.add_option("--seed", o.settings.seed, "another seed, another noise")
        ->default_str("0")
        ->group("Sampling");
}

void addAdaptive(CLI::App& app, Raw& raw) {
    app.add_option("-a,--adaptive", raw.adaptive,
                   "adaptive sampling: test a pixel every BATCH samples, stop at 1.96 sigma <= "
                   "TOLERANCE * mean [off; --cs184: 32 0.05]")
        ->expected(2)
        ->allow_extra_args(false)
        ->type_name("BATCH TOLERANCE")
        ->group("Sampling");
}

void addDevice(CLI::App& app, Options& o) {
    app.add_option("--device", o.device,
                   "number, UUID or part of a name from 'stromboli devices', or cpu [the best]")
        ->type_name("D")
        ->group("Device");
}

void addHost(CLI::App& app, Raw& raw, Options& o) {
    app.add_option("-t,--threads", o.threads, "host threads (BVH, reference) [all]")
        ->type_name("N")
        ->group("Device");
    app.add_flag("-q,--quiet", raw.quiet, "warnings and errors only")->group("Messages");
    app.add_flag("-v,--verbose", raw.verbose, "more detail")->group("Messages");
}

void addRender(CLI::App& app, Raw& raw, Options& o) {
    addScene(app, o);
    app.add_option("-o,--output", o.output, "picture to write: .png (sRGB, 8 bit) or .exr (linear)")
        ->required()
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--exposure", o.exposure, "PNG: radiance times 2^EV")
        ->default_str("0")
        ->type_name("EV")
        ->group("Output");
    app.add_flag("--aov", o.statisticsChannels, "EXR: also sample counts and variances of the mean")
        ->group("Output");
    app.add_option("--stats", o.statsFile, "write statistics of the render as JSON")
        ->type_name("FILE.json")
        ->group("Output");
    addPicture(app, raw);
    addLightTransport(app, raw, o);
    addSampling(app, raw, o, "samples per pixel; with -a the most a pixel gets [64; --cs184: 1]");
    addAdaptive(app, raw);
    app.add_option("--backend", raw.backend,
                   "vulkan, or reference: the slow double-precision path tracer on the CPU")
        ->check(CLI::IsMember({"vulkan", "reference"}))
        ->default_str("vulkan")
        ->type_name("WHICH")
        ->group("Device");
    addDevice(app, o);
    addHost(app, raw, o);
    app.add_option("--accumulate", raw.accumulate, "CS184's -o: 0 is --min-bounce equal to -m")
        ->group("");
}

void checkRange(const char* what, double value, double least, double most) {
    if (!(value >= least && value <= most))
        throw UsageError(fmt::format("{} is {}: expected {} to {}", what, value, least, most));
}

void applySize(const Raw& raw, Options& o) {
    if (raw.size.empty()) return;
    checkRange("-r: width", raw.size[0], 1, kLargestSide);
    checkRange("-r: height", raw.size[1], 1, kLargestSide);
    o.settings.width = raw.size[0];
    o.settings.height = raw.size[1];
    o.sizeGiven = true;
}

/// The crop is checked against the picture once its size is known (job.cpp); here its own sense.
void applyCrop(const Raw& raw, Options& o) {
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

void applyAdaptive(const Raw& raw, Options& o) {
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

void applyLight(const Raw& raw, Options& o) {
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
                                                                 : DirectLight::Lights;
    s.roulette = parseRoulette(raw.roulette, s.cs184);
}

void apply(const Raw& raw, Options& o) {
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
}

} // namespace

std::optional<Options> parseOptions(std::vector<std::string> arguments) {
    Options o;
    Raw raw;
    CLI::App app("Stromboli: a path tracer in Vulkan compute shaders.\n"
                 "COLLADA in, PNG or EXR out; on any Vulkan 1.1 device, GPU or not.",
                 "stromboli");
    app.set_version_flag("--version", std::string("stromboli ") + STROMBOLI_VERSION);
    app.require_subcommand(1);
    app.footer("'stromboli COMMAND --help' explains a command. Exit codes: 0 done, 1 usage, "
               "2 scene, 3 device, 4 output.");
    CLI::App* render = app.add_subcommand("render", "Render a scene to a picture");
    addRender(*render, raw, o);
    CLI::App* check = app.add_subcommand(
        "check", "Render on the device and with the CPU reference; say whether they agree");
    addScene(*check, o);
    addPicture(*check, raw, "picture size [160 120]");
    addLightTransport(*check, raw, o);
    addSampling(*check, raw, o, "samples per pixel [256]");
    check->add_option("--alpha", o.familyWiseError, "probability of a false alarm")
        ->check(CLI::Range(1e-12, 0.5))
        ->default_str("0.01")
        ->group("Sampling");
    addDevice(*check, o);
    addHost(*check, raw, o);
    CLI::App* info = app.add_subcommand(
        "info", "What a scene holds, what its kernel contains, sizes of all buffers, its BVH");
    addScene(*info, o);
    addPicture(*info, raw);
    addLightTransport(*info, raw, o);
    addHost(*info, raw, o);
    CLI::App* devices =
        app.add_subcommand("devices", "List Vulkan devices and which one is chosen, and why");
    addDevice(*devices, o);

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
    o.command = *render  ? Command::Render
                : *check ? Command::Check
                : *info  ? Command::Info
                         : Command::Devices;
    if (*check) { // a quick, small picture unless asked otherwise
        if (raw.size.empty()) raw.size = {160, 120};
        if (!raw.samples) raw.samples = 256;
    }
    apply(raw, o);
    if (*check) o.settings.adaptive.enabled = false; // a z-test needs fixed sample counts
    return o;
}

} // namespace stromboli
