// Which options each command has.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/core/output.hpp"
#include "host/film/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

constexpr Range<double> kSeconds{0.01, 1e9};
constexpr Range<double> kErrorRates{1e-12, 0.5};

std::vector<Layer> readLayers(const std::string& list) {
    std::vector<Layer> layers;
    for (size_t first = 0, end = 0; end != std::string::npos; first = end + 1) {
        end = list.find(',', first);
        const std::string name = list.substr(first, end - first);
        const std::optional<Layer> layer = valueNamed<Layer>(name);
        if (!layer) refuse("--layers", name, allNames<Layer>());
        if (std::ranges::count(layers, *layer) > 0)
            throw UsageError(fmt::format("--layers names {} twice", name));
        layers.push_back(*layer);
    }
    return layers;
}

void declareOutput(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Output");
    c.list
        .text("-o,--output", "FILE",
              "picture to write: .png (sRGB, 8 bit) or .exr (linear); -: a PNG on standard output; "
              "with "
              "--share a .film",
              o.output)
        .besidePicture()
        .proposes(Proposed::Files);
    declarePictureFile(c);
    declareSeen(c);
    c.list
        .text("--stats", "FILE.json",
              "write statistics of the render as JSON; - for standard output", o.statsFile)
        .besidePicture()
        .proposes(Proposed::Files);
}

/// Each has files of its own.
void checkSeveralPictures(const Options& o) {
    if (o.cameras.empty()) return;
    if (o.sampleAlone) throw UsageError("--pixel is of one picture: --camera names several");
    if (isStandardOutput(o.output))
        throw UsageError("-o - has place for one picture: --camera names several");
    if (o.statsFile == "-")
        throw UsageError("--stats - has place for one picture's: --camera names several");
}

/// What is given and has no effect here: said, and not refused, because these options are added to
/// command lines that are there already.
void remarkOnWhatIsIgnored(DeclaredCommand& c) {
    Options& o = c.options;
    const auto remark = [&](const std::string& because, const std::vector<std::string>& names) {
        const std::string ignored = c.givenOf(names);
        if (!ignored.empty()) o.remarks.push_back(fmt::format("{}: ignored: {}", because, ignored));
    };
    if (o.sampleAlone)
        remark("--pixel prints one sample and makes no picture",
               {"-o", "--stats", "--exposure", "--aov", "--layers", "--notes", "--crop", "--cell"});
    if (isStandardOutput(o.output) && (o.budget.adaptive.enabled || o.budget.stop.open()))
        o.remarks.emplace_back(
            "-o - has no place for a second picture: the rate picture is left out");
}

void declareCheckpoints(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Going on");
    c.list
        .text("--checkpoint", "FILE",
              "keep the state of the render there, and leave it at the end; off: nowhere",
              o.checkpointFile)
        .usually("OUTPUT.checkpoint, from the first minute to the end of the render")
        .besidePicture()
        .proposes({"off"})
        .proposes(Proposed::Files);
    c.list
        .real("--checkpoint-every", "S", "seconds from one checkpoint to the next",
              o.checkpointSeconds, kSeconds)
        .besidePicture();
    c.list
        .flag("--resume",
              "go on from the checkpoint, to the same bytes as if never interrupted; also with "
              "another -s, --noise, --time or -a (--time counts all runs); with --share: the film "
              "of this share is kept if it is there",
              o.resume)
        .besidePicture();
}

void declareRender(DeclaredCommand& c) {
    Options& o = c.options;
    declareScene(c);
    declareOutput(c);
    declarePicture(c);
    declareSequence(c);
    declareEstimator(c);
    declareSamples(c, "samples per pixel, on the mean: they go where they help most (--even: to "
                      "all alike); with -a, --noise and --time the most a pixel gets");
    declareBranches(c, "4 where bounces make most of the noise, else 1 (docs/estimator.md)");
    declareSpreading(c);
    declareSampleAlone(c);
    declareShare(c);
    declareCheckpoints(c);
    declareFilmMemory(c);
    c.list.choice("--backend", "WHICH", "what takes the samples", o.backend);
    declareDevice(c);
    c.list
        .choice("--scheduler", "WHICH",
                "what a device's lanes do next; the picture is the same (docs/kernel.md)",
                o.scheduler)
        .besidePicture();
    declareHost(c);
    c.list
        .number("--accumulate", "N", "CS184's -o: 0 is --min-bounce equal to -m",
                c.asked.accumulate, {0, 0xFFFFFFFFu})
        .excludes("--min-bounce", "both say which bounces are left out")
        .hidden();
    c.finish = [&c, &o] {
        finishPicture(c);
        finishEstimator(c);
        finishBudget(c, true);
        o.estimator.showsBackdrop = !o.transparent;
        checkSeveralPictures(o);
        checkSequence(c);
        if (o.output.empty() && !o.sampleAlone)
            throw UsageError("--output is required (see --help)");
        if (o.backend == BackendChoice::Reference && c.has("--device"))
            throw UsageError("--device and --backend reference exclude each other: the reference "
                             "runs on the CPU, without Vulkan");
        if (o.share)
            finishShare(c);
        else if (!o.sampleAlone)
            checkOutputOptions(c);
        remarkOnWhatIsIgnored(c);
    };
}

void declareCheck(DeclaredCommand& c) {
    Options& o = c.options;
    o.area = {160, 120, {}}; // quick
    o.sizeGiven = true;
    c.asked.usualPaths = 256;
    declareScene(c);
    declarePicture(c);
    declareEstimator(c);
    declareSamples(c, "samples per pixel");
    declareBranches(c, "1");
    c.list.group("Sampling");
    c.list.real("--alpha", "P", "probability of a false alarm", o.familyWiseError, kErrorRates);
    declareDevice(c);
    declareHost(c);
    c.finish = [&c, &o] {
        finishPicture(c);
        finishEstimator(c);
        finishBudget(c, false);
        o.budget.adaptive.enabled = false; // a z-test needs fixed sample counts
    };
}

void declareInfo(DeclaredCommand& c) {
    declareScene(c);
    declarePicture(c);
    declareEstimator(c);
    declareSampler(c, c.options.estimator.sampler);
    c.list.group("Output");
    c.list
        .text("--json", "FILE.json", "write all of it as JSON instead; - for standard output",
              c.options.infoJsonFile)
        .proposes(Proposed::Files);
    declareHost(c);
    c.finish = [&c] {
        finishPicture(c);
        finishEstimator(c);
        finishBudget(c, false);
    };
}

void declareKernels(DeclaredCommand& c) {
    declareScene(c);
    declarePicture(c);
    declareEstimator(c);
    declareSampler(c, c.options.estimator.sampler);
    declareDevice(c);
    c.list
        .text(
            "--device-family", "F",
            "compile for this family of AMD GPUs, which need not be there: navi21, gfx1100, vega10",
            c.options.deviceFamily)
        .usually("the device itself")
        .proposes({"navi21", "gfx1100", "vega10"});
    declareHost(c);
    c.finish = [&c] {
        finishPicture(c);
        finishEstimator(c);
        finishBudget(c, false);
    };
}

void declareDevices(DeclaredCommand& c) {
    declareDevice(c);
}

} // namespace

void declareSeen(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Output");
    c.list.flag("--transparent",
                "the picture has alpha: what no surface covers is transparent, and the camera does "
                "not see the environment, which lights the scene all the same",
                o.transparent);
    c.list
        .words("--layers", "LIST",
               fmt::format("EXR: also these channels, with commas between (docs/layers.md): {}",
                           allMeanings<Layer>()),
               1, [&o](const Words& words) { o.layers = readLayers(words[0]); })
        .proposes(namesOf<Layer>());
}

void checkOutputOptions(const DeclaredCommand& c) {
    const Options& o = c.options;
    const bool isExr = !isPng(o.output);
    if (o.statisticsChannels && !isExr)
        throw UsageError(
            fmt::format("--aov needs an EXR file: {} has no channels for it", o.output));
    if (!o.layers.empty() && !isExr)
        throw UsageError(fmt::format(
            "--layers needs an EXR file (-o name.exr): {} has no channels for them", o.output));
    if (c.has("--exposure") && isExr)
        throw UsageError(
            fmt::format("--exposure is for PNG: {} holds radiance as it is", o.output));
}

std::deque<DeclaredCommand> declareCommands() {
    struct Row {
        Command command;
        const char* name;
        const char* description;
        void (*declare)(DeclaredCommand&);
    };
    static constexpr Row kRows[] = {
        {Command::Render, "render", "Render a scene to a picture", declareRender},
        {Command::Check, "check",
         "Render on the device and with the CPU reference; say whether they agree", declareCheck},
        {Command::Info, "info",
         "What a scene holds, what its kernel contains, sizes of all buffers, its BVH",
         declareInfo},
        {Command::Kernels, "kernels",
         "What a GPU's driver makes of a scene's kernels: registers, spills, waves",
         declareKernels},
        {Command::Devices, "devices", "List Vulkan devices and which one is chosen, and why",
         declareDevices},
        {Command::Bench, "bench",
         "Measure BVH, rays, paths, start-up; against Embree where that is installed",
         declareBench},
        {Command::Compare, "compare",
         "How far a picture is from a reference: relMSE, PSNR, SSIM, FLIP, bias; limits",
         declareCompare},
        {Command::Merge, "merge",
         "Put films of shares (render --share) together: to a picture, or to a film again",
         declareMerge},
        {Command::Plan, "plan",
         "Spread the samples of the next round of shares to where films are noisy", declarePlan},
        {Command::Submit, "submit",
         "Have a cluster render a picture: shares on its nodes, and their merge", declareSubmit},
        {Command::Study, "study",
         "Error against time and samples of several configurations; a report to look at",
         declareStudy},
        {Command::Stress, "stress",
         "Try the hard cases of docs/hard_cases.md on the device: does it do them right?",
         declareStress},
    };
    std::deque<DeclaredCommand> commands;
    for (const Row& row : kRows) {
        DeclaredCommand& c = commands.emplace_back();
        c.name = row.name;
        c.description = row.description;
        c.options.command = row.command;
        row.declare(c);
    }
    return commands;
}

} // namespace stromboli
