// `bench`: speed, against Embree where it is installed.
#include "host/bench/report.hpp"
#include "host/bench/startup_bench.hpp"
#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "scene/find_scene.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

namespace stromboli {
namespace {

constexpr Range<uint32_t> kRepeats{1, 1000}, kRaysPerPixel{1, 1024}, kSide{1, 65536},
    kBounces{0, 10000}, kSamples{1, kMostSamples}, kSeeds{0, 0xFFFFFFFFu};
/// What scene/generate makes.
constexpr Range<uint32_t> kTriangles{1000, 100'000'000};

bench::Part partNamed(const std::string& name) {
    if (const auto part = valueNamed<bench::Part>(name)) return *part;
    throw UsageError(fmt::format("--only is '{}': expected {}", name, allNames<bench::Part>()));
}

/// A short run.
void beQuick(bench::BenchSettings& s) {
    s.scenes = {"reading_room", "bathroom"};
    s.repeats = 3;
    s.leastSeconds = 0.05;
    s.width = s.height = 192;
    s.samplesPerPixel = 4;
}

void declareMeasuring(OptionList& list, bench::BenchSettings& s) {
    list.group("Measuring");
    list.flag("--quick", "a short run: small pictures, few repeats, two rooms",
              [&s] { beQuick(s); })
        .changesDefaults();
    list.number("--repeats", "N", "rounds; each measures every contestant once", s.repeats,
                kRepeats);
    list.number("--rays", "N", "camera rays a pixel in ray sets", s.raysPerPixel, kRaysPerPixel)
        .usually("CPU: 1, GPU: 16");
    list.words("--only", "PART,PART,...", "what to measure (" + allMeanings<bench::Part>() + ")", 1,
               [&s](const Words& words) {
                   s.parts.clear();
                   for (const std::string& word : words)
                       s.parts.insert(partNamed(word));
               })
        .usually("all")
        .proposes(namesOf<bench::Part>())
        .separatedByCommas = true;
    list.numbers("-r,--size", "W H", "picture size", {&s.width, &s.height}, kSide)
        .usually(fmt::format("{} {}; --quick: 192 192", s.width, s.height));
    list.number("-m,--max-bounces", "N", "scatterings of light at most", s.maxBounces, kBounces);
    list.group("Sampling");
    list.number("-s,--samples", "N", "samples per pixel in a measurement of paths",
                s.samplesPerPixel, kSamples)
        .usually(fmt::format("{}; --quick: 4", s.samplesPerPixel));
    list.choice("--sampler", "WHICH", "where random numbers come from", s.sampler);
    list.number("--seed", "N", "another seed, another noise", s.seed, kSeeds);
}

/// What is given and no part that is measured asks for.
void remarkOnWhatIsLeftOut(DeclaredCommand& c, const bench::BenchSettings& s) {
    using bench::Part;
    struct Row {
        std::vector<std::string> options;
        std::set<Part> parts; ///< that heed them
        bool bySizes;         ///< --sizes does
    };
    const std::set<Part> paths = {Part::Paths, Part::Variants, Part::Textures};
    const Row rows[] = {
        {{"SCENE"},
         {Part::Bvh, Part::Rays, Part::Paths, Part::Variants, Part::Textures, Part::Startup},
         false},
        {{"--rays"}, {Part::Rays}, true},
        {{"-r", "--seed"}, {Part::Rays, Part::Paths, Part::Variants, Part::Textures}, true},
        {{"-m", "-s", "--sampler"}, paths, false},
    };
    std::vector<std::string> unheeded;
    for (const Row& row : rows) {
        const bool heeded =
            (row.bySizes && !s.sizes.empty()) ||
            std::ranges::any_of(row.parts, [&](Part part) { return s.parts.contains(part); });
        if (!heeded) unheeded.insert(unheeded.end(), row.options.begin(), row.options.end());
    }
    const std::string ignored = c.givenOf(unheeded);
    if (!ignored.empty())
        c.host.remarks.push_back(
            fmt::format("--only leaves out what asks for it: ignored: {}", ignored));
}

void writeJson(const std::string& file, const bench::BenchReport& report) {
    writeOutput(file, bench::toJson(report).dump(2) + "\n");
}

} // namespace

void declareBench(DeclaredCommand& c) {
    const auto o = std::make_shared<BenchOptions>();
    bench::BenchSettings& s = o->settings;
    OptionList& list = c.list;
    list.group("Scenes");
    list.list("SCENE", "", "files, bundled scenes by name, or generate:cornell_mesh:N", s.scenes)
        .usually(fmt::format("{}", fmt::join(s.scenes, " ")))
        .proposes(Proposed::Scenes);
    list.words("--sizes", "N,N,...",
               "also: time per ray in the generated mesh of so many triangles each, as "
               "1k,10k,100k,1M,4M",
               1,
               [&s](const Words& words) {
                   s.sizes.clear();
                   for (const std::string& word : words)
                       s.sizes.push_back(readNumber("--sizes", word, kTriangles));
               })
        .from(inWords(kTriangles))
        .separatedByCommas = true;
    declareMeasuring(list, s);
    list.group("Output");
    list.text("--json", "FILE.json", "write all measurements as JSON", o->jsonFile)
        .proposes(Proposed::Files);
    list.flag("--probe-startup", "time the stages of this process's start, and no more",
              o->probeStartup)
        .hidden();
    declareDevice(list, s.device);
    declareHost(c);
    c.finish = [&c, o] {
        o->settings.threads = c.host.threads;
        remarkOnWhatIsLeftOut(c, o->settings);
        return *o;
    };
}

int benchCommand(const BenchOptions& options) {
    bench::BenchSettings settings = options.settings;
    if (options.probeStartup) {
        fmt::print("{}", bench::toText(bench::probeStartup(sceneFile(settings.scenes.front()),
                                                           settings.device)));
        return 0;
    }
    if (!options.jsonFile.empty()) checkOutputWritable(options.jsonFile);
    settings.program = std::filesystem::read_symlink("/proc/self/exe").string();
    settings.commandLine = commandLine();
    settings.messages = toTerminal().message;
    onSignal(OnSignal::Ask);
    try {
        const bench::BenchReport report = bench::runBench(settings, [&](const std::string& step) {
            if (interrupted()) throw bench::Stopped();
            nowDoing("measuring", StatusLine::OfOthers);
            status_line::draw(step);
        });
        status_line::clear();
        if (!isStandardOutput(options.jsonFile)) fmt::print("{}", bench::toTable(report));
        if (!options.jsonFile.empty()) writeJson(options.jsonFile, report);
    } catch (const bench::Stopped&) {
        logging::warn("interrupted: nothing is reported");
        return interruptedExitCode();
    }
    return 0;
}

} // namespace stromboli
