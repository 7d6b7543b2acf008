// Which options each command has.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"

namespace stromboli {
namespace {

constexpr Range<double> kStops{-100, 100};
constexpr Range<double> kErrorRates{1e-12, 0.5};

void declareOutput(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Output");
    c.list.text("-o,--output", "FILE", "picture to write: .png (sRGB, 8 bit) or .exr (linear)",
                o.output);
    c.list.real("--exposure", "EV", "PNG: radiance times 2^EV", o.tone.exposure, kStops);
    c.list.flag("--aov", "EXR: also sample counts and variances of the mean", o.statisticsChannels);
    c.list.text("--stats", "FILE.json", "write statistics of the render as JSON", o.statsFile);
}

void declareRender(DeclaredCommand& c) {
    Options& o = c.options;
    declareScene(c);
    declareOutput(c);
    declarePicture(c);
    declareEstimator(c);
    declareSamples(c, "samples per pixel, on the mean: they go where they help most (--even: to "
                      "all alike); with -a, --noise and --time the most a pixel gets");
    declareBranches(c, "4 where bounces make most of the noise, else 1 (docs/estimator.md)");
    declareSpreading(c);
    declareSampleAlone(c);
    c.list.group("Device");
    c.list.choice("--backend", "WHICH", "what takes the samples", o.backend);
    declareDevice(c);
    declareHost(c);
    c.list
        .number("--accumulate", "N", "CS184's -o: 0 is --min-bounce equal to -m",
                c.asked.accumulate, {0, 0xFFFFFFFFu})
        .hidden();
    c.finish = [&c, &o] {
        finishPicture(c);
        finishEstimator(c);
        finishBudget(c, true);
        if (o.output.empty() && !o.sampleAlone)
            throw UsageError("--output is required (see --help)");
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
        {Command::Devices, "devices", "List Vulkan devices and which one is chosen, and why",
         declareDevices},
        {Command::Bench, "bench",
         "Measure BVH, rays, paths, start-up; against Embree where that is installed",
         declareBench},
        {Command::Compare, "compare",
         "How far a picture is from a reference: relMSE, PSNR, SSIM, FLIP, bias; limits",
         declareCompare},
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
