#include "host/bench/report.hpp"
#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/options.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/engine/load_scene.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/study/journal.hpp"
#include "host/study/page.hpp"
#include "host/study/run_study.hpp"
#include "scene/build/read_file.hpp"
#include "scene/find_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <span>
#include <variant>

namespace stromboli {

// --- Options -------------------------------------------------------------------------------------

// Options of `study`.

namespace {

/// The configuration that others are compared with, where it takes part.
constexpr const char* kUsualBaseline = "independent";

constexpr uint32_t kMostPaths = 1u << 20; // a reference of 16 times that is the most there can be
constexpr Range<uint32_t> kStudySamples{1, kMostPaths}, kStudySeeds{1, 10000}, kStudySide{1, 65536},
    kStudyBounces{0, 10000};
constexpr Range<double> kSeconds{1e-3, 1e9};

/// What was asked for, before it is known what it means together with the rest.
struct AskedStudy {
    Words configurations = {"independent", "even", "default", "hemisphere"};
    uint32_t width = 480, height = 360, maxBounces = 5;
    std::string moreOptions;
    std::optional<uint32_t> referenceSamples, targetSamples;
};

void declareScenes(OptionList& list, StudyOptions& o) {
    list.group("Scenes");
    list.list("SCENE", "", "files, bundled scenes by name, or generate:cornell_mesh:N",
              o.settings.scenes)
        .proposes(Proposed::Scenes);
    list.group("Output");
    list.text("-o,--output", "FOLDER",
              "folder for report.html, study.json, study.csv, references and pictures; a study "
              "that was stopped goes on where the same command finds its folder",
              o.folder)
        .proposes(Proposed::Folders);
}

void declareConfigurations(OptionList& list, AskedStudy& asked, StudyOptions& o) {
    list.group("Configurations");
    CommandOption& config = list.list(
        "-c,--config", "NAME",
        "a configuration by name (--list), or one of your own as NAME=OPTIONS of render; an option "
        "with {a,b,c} grows along these values instead of along samples, as \"mine=-a 16 "
        "{0.4,0.2,0.1}\"; once for each",
        asked.configurations);
    config.usually(fmt::format("{}", fmt::join(asked.configurations, ", ")));
    config.mayRepeat = true;
    Words known;
    for (const study::Configuration& one : study::knownConfigurations())
        known.push_back(one.name);
    config.proposes(known);
    list.flag("--list", "print the known configurations", o.list);
    list.text("--baseline", "NAME", "what the others are compared with", o.settings.baseline)
        .usually("independent if it takes part, else the first")
        .proposes(known);
    list.text("--options", "OPTIONS", "options of render for every picture", asked.moreOptions);
}

void declareMeasuring(OptionList& list, AskedStudy& asked, StudyOptions& o) {
    study::StudySettings& s = o.settings;
    list.group("Measuring");
    list.flag("--quick", "a short study: small pictures, fewer samples and seeds",
              [&asked, &s] {
                  asked.width = 160, asked.height = 120;
                  s.sampleCounts = {4, 16, 64};
                  s.seeds = 3;
              })
        .changesDefaults();
    list.numbers("-r,--size", "W H", "picture size", {&asked.width, &asked.height}, kStudySide)
        .usually(fmt::format("{} {}; --quick: 160 120", asked.width, asked.height));
    list.number("-m,--max-bounces", "N", "scatterings of light at most", asked.maxBounces,
                kStudyBounces);
    list.words("-s,--samples", "N,N,...", "growing sample counts", 1,
               [&s](const Words& words) {
                   s.sampleCounts.clear();
                   for (const std::string& word : words)
                       s.sampleCounts.push_back(readNumber("-s", word, kStudySamples));
               })
        .from(inWords(kStudySamples))
        .usually(fmt::format("{}; --quick: 4,16,64", fmt::join(s.sampleCounts, ",")))
        .separatedByCommas = true;
    list.number("--seeds", "N", "runs of each configuration", s.seeds, kStudySeeds)
        .usually(fmt::format("{}; --quick: 3", s.seeds));
    list.number("--reference-samples", "N", "of the picture that errors are measured against",
                asked.referenceSamples, {1, 16 * kMostPaths})
        .usually("16 times the largest count");
    list.number("--target-samples", "N",
                "times are compared at the error of the baseline with so many samples",
                asked.targetSamples, kStudySamples)
        .usually("64, or the largest count");
    list.real("--most-seconds", "S", "efforts that would take longer are left out",
              s.mostSecondsPerRun, kSeconds, kTimes);
}

void checkRange(const char* what, uint32_t value, uint32_t least, uint32_t most) {
    if (value < least || value > most)
        throw UsageError(fmt::format("{} is {}: expected {} to {}", what, value, least, most));
}

void finishCounts(const AskedStudy& asked, study::StudySettings& s) {
    for (size_t i = 1; i < s.sampleCounts.size(); ++i)
        if (s.sampleCounts[i] <= s.sampleCounts[i - 1])
            throw UsageError("-s: the sample counts must grow");
    if (s.sampleCounts.size() < 2) throw UsageError("-s: at least two sample counts are needed");
    const uint32_t fewest = s.sampleCounts.front(), largest = s.sampleCounts.back();
    s.referenceSamples = asked.referenceSamples.value_or(16 * largest);
    checkRange("--reference-samples", s.referenceSamples, largest, 16 * kMostPaths);
    s.targetSamples = asked.targetSamples.value_or(std::min(64u, largest));
    checkRange("--target-samples", s.targetSamples, fewest, largest);
}

void finishBaseline(study::StudySettings& s) {
    const auto has = [&](const std::string& name) {
        return std::any_of(s.configurations.begin(), s.configurations.end(),
                           [&](const study::Configuration& c) { return c.name == name; });
    };
    if (s.baseline.empty())
        s.baseline = has(kUsualBaseline) ? kUsualBaseline : s.configurations.front().name;
    if (!has(s.baseline))
        throw UsageError(fmt::format("--baseline: '{}' takes no part in the study", s.baseline));
    for (const study::Configuration& c : s.configurations)
        if (c.name == s.baseline && !c.effort.empty())
            throw UsageError(fmt::format(
                "--baseline: '{}' does not grow along samples; choose another", s.baseline));
}

void finishStudy(const AskedStudy& asked, StudyOptions& o) {
    study::StudySettings& s = o.settings;
    s.configurations = study::chooseConfigurations(asked.configurations);
    if (s.scenes.empty() && !o.list) throw UsageError("SCENE is required (see --help)");
    s.commonOptions = fmt::format("-r {} {} -m {}{}{}", asked.width, asked.height, asked.maxBounces,
                                  asked.moreOptions.empty() ? "" : " ", asked.moreOptions);
    s.referenceOptions = "--sampler independent"; // no structure that a study's runs might share
    finishCounts(asked, s);
    finishBaseline(s);
}

} // namespace

void declareStudy(DeclaredCommand& c) {
    const auto o = std::make_shared<StudyOptions>();
    const auto asked = std::make_shared<AskedStudy>();
    declareScenes(c.list, *o);
    declareConfigurations(c.list, *asked, *o);
    declareMeasuring(c.list, *asked, *o);
    declareDevice(c.list, o->device);
    declareHost(c);
    c.footer = "Errors are relMSE, the mean of (x - r)^2 / (r^2 + 0.01 m^2), r the reference and m "
               "its mean, less what the reference's own noise adds. Times are those of sampling "
               "alone.";
    c.finish = [&c, asked, o] {
        const std::string ignored =
            o->list ? c.givenOf({"SCENE", "-o", "-c", "--baseline", "--options", "--quick", "-r",
                                 "-m", "-s", "--seeds", "--reference-samples", "--target-samples",
                                 "--most-seconds", "--device", "-t"})
                    : "";
        if (!ignored.empty())
            c.host.remarks.push_back("--list measures nothing: ignored: " + ignored);
        finishStudy(*asked, *o);
        o->verbosity = c.host.verbosity;
        return *o;
    };
}

// --- The command ---------------------------------------------------------------------------------

// `study`: error against time of several configurations.

namespace {

namespace fs = std::filesystem;
using study::Study;

/// How far the study is, in the status line.
class StudyLine {
  public:
    StudyLine() = default;
    ~StudyLine() { status_line::clear(); }
    StudyLine(const StudyLine&) = delete;
    StudyLine& operator=(const StudyLine&) = delete;

    void show(const study::StudyProgress& p) {
        constexpr int kWidth = 24; // characters
        constexpr double kLineEverySeconds = 0.25;
        if (!status_line::isShown() || (drawn_ && watch_.seconds() < kLineEverySeconds)) return;
        watch_ = {};
        drawn_ = true;
        const int filled = std::clamp(int(p.share * kWidth), 0, kWidth);
        status_line::draw(fmt::format("{:3.0f} %  {} left  [{:#<{}}{:.<{}}] {}", 100 * p.share,
                                      p.secondsLeft ? formatDuration(*p.secondsLeft) : "?", "",
                                      filled, "", kWidth - filled, p.doing));
    }

  private:
    bool drawn_ = false;
    Stopwatch watch_;
};

std::string checksum(const fs::path& file) {
    return fmt::format("{:08x}", checksumOfFile(file));
}

/// The command line of `render` that a picture of the study is.
RenderOptions renderLine(const std::string& scene, const std::vector<std::string>& words) {
    const std::string file = sceneFile(scene);
    std::vector<std::string> line = {"render", file.empty() ? scene : file, "-o", "study.exr"};
    line.insert(line.end(), words.begin(), words.end());
    const std::optional<ParsedCommand> parsed = parseOptions(line);
    const RenderOptions* options = parsed ? std::get_if<RenderOptions>(&parsed->options) : nullptr;
    if (!options || options->picture.crop.width != 0 || options->pixelAlone)
        throw UsageError(fmt::format("a study renders whole pictures: {}", fmt::join(words, " ")));
    if (!options->output.statsFile.empty() || options->output.statisticsChannels ||
        !options->device.device.empty() || parsed->host.verbosity != Verbosity::Normal)
        throw UsageError(fmt::format("a study has one device and files of its own: --stats, --aov, "
                                     "--device, -q and -v are not for its configurations: {}",
                                     fmt::join(words, " ")));
    return *options;
}

/// What a wrong option would say hours later, when its turn comes.
void checkConfigurations(const study::StudySettings& s) {
    for (const std::string& scene : s.scenes)
        for (const study::Configuration& c : s.configurations) {
            const std::vector<double> none = {0};
            for (const double step : c.steps.empty() ? none : c.steps)
                try {
                    renderLine(scene, study::renderOptions(s, c, step, 1, s.sampleCounts.front()));
                } catch (const UsageError& error) {
                    throw UsageError(fmt::format("configuration '{}': {}", c.name, error.what()));
                }
        }
}

/// Scene and arrays that a backend refers to.
struct Held {
    PreparedPicture prepared;
    BuiltScene built;
};

study::PreparedRender prepareRender(const vulkan::Device& device, const std::string& scene,
                                    const std::vector<std::string>& words) {
    const RenderOptions options = renderLine(scene, words);
    auto held = std::make_shared<Held>(Held{preparePicture(options), {}});
    setVerbosity(Verbosity::ErrorsOnly); // what the loader has to say, it says once
    const Scene& loaded = *held->prepared.scene.scene;
    const auto& [camera, settings] = held->prepared.picture;
    study::PreparedRender render{held, settings, nullptr};
    if (options.device.backend == BackendChoice::Reference) {
        render.backend =
            std::make_unique<ReferenceBackend>(loaded, camera, settings, options.device.threads);
        return render;
    }
    held->built = buildScene(loaded, settings.estimator, toTerminal());
    nowDoing("measuring", StatusLine::OfOthers);
    render.backend = std::make_unique<VulkanBackend>(device, held->built.gpu, camera, settings);
    return render;
}

Study newStudy(const study::StudySettings& settings, const vulkan::Device& device) {
    Study s;
    s.settings = settings;
    const bench::Circumstances c = bench::circumstancesOf(
        device.description(), {}, bench::deviceThreads(device.description()), commandLine());
    s.deviceIsCpu = c.deviceIsCpu;
    s.circumstances = {{"date", c.date},
                       {"command", c.commandLine},
                       {"version", c.version},
                       {"cpu", c.cpu},
                       {"system", c.system},
                       {"cores", std::to_string(c.cores)},
                       {"threads", std::to_string(c.threads)},
                       {"device", c.device},
                       {"driver", c.driver},
                       {"compiler", c.compiler}};
    s.key = fmt::format("program {}, {} on {}, driver {}, {} threads: {} ({})",
                        checksum("/proc/self/exe"), c.device, c.cpu, c.driver, c.threads,
                        settings.commonOptions, settings.referenceSamples);
    for (const std::string& name : settings.scenes) {
        const std::string file = sceneFile(name);
        study::SceneStudy scene;
        scene.name = name;
        scene.content = file.empty() ? name : checksum(file);
        s.scenes.push_back(scene);
    }
    return s;
}

void listConfigurations() {
    for (const study::Configuration& c : study::knownConfigurations())
        fmt::print("{:<14} {:<24} {}\n", c.name,
                   c.options + c.effort + (c.options.empty() && c.effort.empty() ? "-" : ""),
                   c.what);
}

void writeText(const fs::path& path, const std::string& text) {
    writeFileAtomically(path, std::as_bytes(std::span(text)));
}

bool hasRuns(const Study& s) {
    return std::any_of(s.scenes.begin(), s.scenes.end(),
                       [](const study::SceneStudy& scene) { return !scene.runs.empty(); });
}

void writeReports(const fs::path& folder, const Study& s) {
    writeText(folder / "study.json", study::toJson(s).dump(1) + "\n");
    writeText(folder / "study.csv", study::toCsv(s));
    if (hasRuns(s)) writeText(folder / "report.html", study::toPage(s, folder));
}

} // namespace

int studyCommand(const StudyOptions& o) {
    if (o.list) {
        listConfigurations();
        return 0;
    }
    checkConfigurations(o.settings);
    const fs::path folder = o.folder;
    std::error_code failed;
    fs::create_directories(folder, failed);
    checkFileWritable(folder / "study.json");
    const study::FolderLock lock(folder);
    onSignal(OnSignal::Ask); // every run that is done is on the disk
    nowDoing("measuring", StatusLine::OfOthers);
    const vulkan::OpenDevice open = vulkan::openDevice(o.device, toTerminal().message);
    Study s = newStudy(o.settings, *open.device);
    const size_t before = study::takeOver(folder / "study.json", s);
    if (before > 0) logging::info(fmt::format("going on: {} runs are there already", before));
    const bool complete = [&] {
        StudyLine line;
        return study::runStudy(
            folder, s,
            {[&](const std::string& scene, const std::vector<std::string>& words) {
                 return prepareRender(*open.device, scene, words);
             },
             [&](const study::StudyProgress& progress) { line.show(progress); }, interrupted});
    }();
    setVerbosity(o.verbosity);
    writeReports(folder, s);
    vulkan::requireNoValidationMessages(open);
    fmt::print("{}", study::toText(s));
    if (hasRuns(s)) fmt::print("\nreport: {}\n", (folder / "report.html").string());
    if (complete) return 0;
    logging::warn("interrupted: what is done is kept; the same command goes on");
    return interruptedExitCode();
}

} // namespace stromboli
