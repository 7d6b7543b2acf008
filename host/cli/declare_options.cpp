#include "host/cli/declare_options.hpp"

#include <CLI/CLI.hpp>

namespace stromboli {
namespace {

void addScene(CLI::App& app, Options& o) {
    app.add_option(
           "SCENE", o.scene,
           "COLLADA file (.dae), or generate:cornell_mesh:N for a scene of N triangles made "
           "in memory, generate:lamps:N for one lit by N triangles")
        ->required()
        ->group("Scene");
}

void addPicture(CLI::App& app, RawOptions& raw,
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

void addLightChoice(CLI::App& app, RawOptions& raw) {
    app.add_option("--light-choice", raw.lightChoice,
                   "which of many emissive triangles a light sample takes: tree, by what it is "
                   "likely to bring to the surface; power; or uniform")
        ->check(CLI::IsMember({"tree", "power", "uniform"}))
        ->default_str("tree")
        ->type_name("HOW")
        ->group("Light");
}

void addLightTransport(CLI::App& app, RawOptions& raw, Options& o) {
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
                   "how lamps are found from a surface: mis, by sampling each lamp and from rough "
                   "metals by bounces too; lights, by sampling alone; hemisphere, by uniform "
                   "directions; bsdf, by bounces")
        ->check(CLI::IsMember({"mis", "lights", "hemisphere", "bsdf"}))
        ->default_str("mis")
        ->type_name("HOW")
        ->group("Light");
    app.add_flag("-H", raw.hemisphere, "same as --direct hemisphere")->group("Light");
    addLightChoice(app, raw);
    app.add_option("--roulette", raw.roulette,
                   "none, throughput (from bounce 3 on), or a probability P of ending a path at "
                   "every hit [throughput; --cs184: none]")
        ->type_name("MODE")
        ->group("Light");
    app.add_option("--guide", raw.guide,
                   "on: some bounces go into the bright gap between a lamp and a surface close to "
                   "it; off: all as the materials scatter")
        ->check(CLI::IsMember({"on", "off"}))
        ->default_str("on")
        ->type_name("WHETHER")
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

void addSampler(CLI::App& app, RawOptions& raw) {
    app.add_option(
           "--sampler", raw.sampler,
           "sobol: the samples of a pixel spread evenly, less noise; independent: each on its "
           "own [sobol; --cs184: independent]")
        ->check(CLI::IsMember({"independent", "sobol"}))
        ->type_name("WHICH")
        ->group("Sampling");
}

void addSampling(CLI::App& app, RawOptions& raw, Options& o, const char* samplesHelp) {
    app.add_option("-s,--samples", raw.samples, samplesHelp)->type_name("N")->group("Sampling");
    addSampler(app, raw);
    app.add_option("--seed", o.settings.seed, "another seed, another noise")
        ->default_str("0")
        ->group("Sampling");
}

void addBranches(CLI::App& app, RawOptions& raw, const char* what) {
    app.add_option("--branches", raw.branches,
                   std::string("paths that share a camera ray and the light samples where it ends; "
                               "-s, which counts paths, is a multiple of it [") +
                       what + "]")
        ->type_name("K")
        ->group("Sampling");
}

void addAdaptive(CLI::App& app, RawOptions& raw) {
    app.add_option("-a,--adaptive", raw.adaptive,
                   "adaptive sampling: test a pixel every BATCH samples, stop at 1.96 sigma <= "
                   "TOLERANCE * mean [off; --cs184: 32 0.05]")
        ->expected(2)
        ->allow_extra_args(false)
        ->type_name("BATCH TOLERANCE")
        ->group("Sampling");
}

void addStopRule(CLI::App& app, RawOptions& raw) {
    app.add_option(
           "--noise", raw.noise,
           "go on until the picture's noise, the square root of its estimated relMSE, is at "
           "most T (0.02: 2 %); samples go where they help most; -s is the most per pixel")
        ->type_name("T")
        ->group("Sampling");
    app.add_option("--time", raw.seconds,
                   "render for at most S seconds (loading not counted); samples go where they help "
                   "most; -s is the most per pixel")
        ->type_name("S")
        ->group("Sampling");
}

/// As a line about rejected samples names one: added to the same command, they show it again.
void addSampleAlone(CLI::App& app, RawOptions& raw) {
    CLI::Option* pixel = app.add_option("--pixel", raw.pixel,
                                        "with --sample: no picture, only print the radiance of "
                                        "one sample of this pixel (column, row from the top)")
                             ->expected(2)
                             ->allow_extra_args(false)
                             ->type_name("X Y")
                             ->group("Sampling");
    CLI::Option* sample =
        app.add_option("--sample", raw.sample, "the sample's number, the first being 0")
            ->type_name("N")
            ->group("Sampling");
    pixel->needs(sample);
    sample->needs(pixel);
}

void addDevice(CLI::App& app, Options& o) {
    app.add_option("--device", o.device,
                   "number, UUID or part of a name from 'stromboli devices', or cpu [the best]")
        ->type_name("D")
        ->group("Device");
}

void addHost(CLI::App& app, RawOptions& raw, Options& o) {
    app.add_option("-t,--threads", o.threads, "host threads (BVH, reference) [all]")
        ->type_name("N")
        ->group("Device");
    app.add_flag("-q,--quiet", raw.quiet, "warnings and errors only")->group("Messages");
    app.add_flag("-v,--verbose", raw.verbose, "more detail")->group("Messages");
}

void addRender(CLI::App& app, RawOptions& raw, Options& o) {
    addScene(app, o);
    app.add_option("-o,--output", o.output, "picture to write: .png (sRGB, 8 bit) or .exr (linear)")
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
    addSampling(
        app, raw, o,
        "samples per pixel, on the mean: they go where they help most (--even: to all alike); "
        "with -a, --noise and --time the most a pixel gets [64; --cs184: 1]");
    addBranches(app, raw, "4 where bounces make most of the noise, else 1 (docs/estimator.md)");
    app.add_flag(
           "--even", raw.even,
           "the same number of samples for every pixel, so that a --crop has the bytes it has "
           "in the whole picture")
        ->group("Sampling");
    addAdaptive(app, raw);
    addStopRule(app, raw);
    addSampleAlone(app, raw);
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

void addBench(CLI::App& app, RawOptions& raw, Options& o) {
    declareBench(app, raw.bench, o.bench);
    app.add_option("-r,--size", raw.size, "picture size [512 512; --quick: 192 192]")
        ->expected(2)
        ->allow_extra_args(false)
        ->type_name("W H")
        ->group("Measuring");
    app.add_option("-m,--max-bounces", raw.maxBounces, "scatterings of light at most [5]")
        ->type_name("N")
        ->group("Measuring");
    addSampling(app, raw, o, "samples per pixel in a measurement of paths [8; --quick: 4]");
    addDevice(app, o);
    addHost(app, raw, o);
}

} // namespace

Subcommands declareOptions(CLI::App& app, RawOptions& raw, Options& o) {
    app.description("Stromboli: a path tracer in Vulkan compute shaders.\n"
                    "COLLADA in, PNG or EXR out; on any Vulkan 1.1 device, GPU or not.");
    app.name("stromboli");
    app.set_version_flag("--version", std::string("stromboli ") + STROMBOLI_VERSION);
    app.require_subcommand(1);
    app.footer("'stromboli COMMAND --help' explains a command. Exit codes: 0 done, 1 usage, "
               "2 scene, 3 device (or a difference found), 4 output.");
    CLI::App* render = app.add_subcommand("render", "Render a scene to a picture");
    addRender(*render, raw, o);
    CLI::App* check = app.add_subcommand(
        "check", "Render on the device and with the CPU reference; say whether they agree");
    addScene(*check, o);
    addPicture(*check, raw, "picture size [160 120]");
    addLightTransport(*check, raw, o);
    addSampling(*check, raw, o, "samples per pixel [256]");
    addBranches(*check, raw, "1");
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
    addSampler(*info, raw);
    addHost(*info, raw, o);
    CLI::App* devices =
        app.add_subcommand("devices", "List Vulkan devices and which one is chosen, and why");
    addDevice(*devices, o);
    CLI::App* bench = app.add_subcommand(
        "bench", "Measure BVH, rays, paths, start-up; against Embree where that is installed");
    addBench(*bench, raw, o);
    CLI::App* compare = app.add_subcommand(
        "compare", "How far a picture is from a reference: relMSE, PSNR, SSIM, FLIP, bias; limits");
    declareCompare(*compare, o.compare);
    CLI::App* study = app.add_subcommand(
        "study", "Error against time and samples of several configurations; a report to look at");
    declareStudy(*study, raw.study, o.study);
    addDevice(*study, o);
    addHost(*study, raw, o);
    CLI::App* stress = app.add_subcommand(
        "stress", "Try the hard cases of docs/hard_cases.md on the device: does it do them right?");
    declareStress(*stress, o.stress);
    addDevice(*stress, o);
    addHost(*stress, raw, o);
    return {render, check, info, devices, bench, compare, study, stress};
}

} // namespace stromboli
