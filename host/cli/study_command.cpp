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
#include "host/engine/render_session.hpp"
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
    if (!options || options->picture.crop.width != 0 || options->pixelAlone ||
        options->picture.shadowCatcher)
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

/// Takes the picture by a session of the engine, which denoises it. The scene is there
/// before, and times begin with the first sample.
study::PreparedRender prepareDenoised(const std::string& device, const RenderOptions& options,
                                      PreparedPicture&& prepared) {
    struct Measured {
        PreparedPicture prepared;
        RenderRequest request;
        std::optional<study::MeasuredPicture> picture;
        std::optional<Stopwatch> wall; ///< from the first sample on
        std::optional<bench::CpuClock> cpu;
        std::optional<RenderSession> session;
    };
    auto kept = std::make_shared<Measured>();
    kept->prepared = std::move(prepared);
    kept->request = options.picture;
    Listener listener;
    listener.activity = [k = kept.get()](Stage stage, const std::string&) {
        if (stage == Stage::Sampling && !k->wall) k->wall.emplace(), k->cpu.emplace();
    };
    DeviceRequest on = options.device;
    on.device = device;
    kept->session.emplace(on, listener);
    RenderRequest first = kept->request;
    first.budget = {};
    first.budget.mostPathsPerPixel = 1;
    first.branches = 1;
    kept->session->begin(kept->prepared.scene.scene, first);
    kept->session->run();
    nowDoing("measuring", StatusLine::OfOthers);
    study::PreparedRender render{kept, kept->prepared.picture.settings, nullptr, {}};
    render.denoised = [k = kept.get()](const std::function<bool()>& goesOn) {
        SessionEvents events;
        events.progress = [&](const RenderProgress&) {
            return goesOn() ? Next::GoOn : Next::Cancel;
        };
        events.bandDone = [&](const FinishedBand& band) {
            k->picture = study::MeasuredPicture{band.film, band.noise, k->wall->seconds(),
                                                k->cpu->seconds(), 0};
        };
        k->wall.reset(), k->cpu.reset(), k->picture.reset();
        k->session->begin(k->prepared.scene.scene, k->request);
        const RenderResult result = k->session->run(events);
        if (result.cancelled) k->picture.reset();
        if (k->picture) k->picture->rays = result.counters.rays;
        return k->picture;
    };
    return render;
}

study::PreparedRender prepareRender(const vulkan::Device& device, const std::string& scene,
                                    const std::vector<std::string>& words) {
    const RenderOptions options = renderLine(scene, words);
    auto held = std::make_shared<Held>(Held{preparePicture(options), {}});
    setVerbosity(Verbosity::ErrorsOnly); // what the loader has to say, it says once
    if (options.picture.denoiser != Denoiser::Off)
        return prepareDenoised(device.description().name(), options, std::move(held->prepared));
    const Scene& loaded = *held->prepared.scene.scene;
    const auto& [camera, settings] = held->prepared.picture;
    study::PreparedRender render{held, settings, nullptr, {}};
    if (options.device.backend == BackendChoice::Reference) {
        render.backend =
            std::make_unique<ReferenceBackend>(loaded, camera, settings, options.device.threads);
        return render;
    }
    held->built = buildScene(loaded, settings.estimator, toTerminal());
    fitToPicture(held->built.gpu, loaded, camera, settings.estimator);
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
