// `regress`: a suite of pictures against golden ones.
#include "host/bench/report.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/system.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/image_formats.hpp"
#include "host/regress/reports.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <variant>

namespace stromboli {

void declareRegress(DeclaredCommand& c) {
    const auto o = std::make_shared<RegressOptions>();
    c.list.group("Suite");
    c.list.text("SUITE", "", "a file that names pictures (.toml; docs/guide/regress.md)", o->suite)
        .required()
        .proposes(Proposed::Files);
    c.list
        .words("--only", "NAME,...", "only these pictures", 1,
               [o](const Words& words) {
                   for (const std::string& name : words)
                       if (name.empty())
                           throw UsageError(
                               "--only: expected names of pictures, with commas between them");
                   o->only = words;
               })
        .separatedByCommas = true;
    c.list.flag("--update", "make the golden pictures anew, and show what they were before",
                o->update);
    c.list.group("Output");
    c.list
        .text("-o,--output", "FOLDER",
              "folder for report.html, results.json, junit.xml and the new pictures", o->folder)
        .proposes(Proposed::Folders);
    declareDevice(c.list, o->device.device);
    declareHost(c);
    c.footer =
        "Exit codes: 0 all pictures agree; 3 one differs, has no golden picture or could not "
        "be made; 6 none differs, but one has too few samples to tell.";
    c.finish = [&c, o] {
        o->device.threads = c.host.threads;
        o->device.maybeSeveral = false;
        o->verbosity = c.host.verbosity;
        return *o;
    };
}

namespace {

namespace fs = std::filesystem;
using regress::SuitePicture;

/// Samples of golden pictures are others than those of the pictures that they judge.
constexpr uint32_t kGoldenSeed = 0x601DE200u;

/// The command line of `render` that a picture of the suite is. z-tests want samples that know
/// nothing of each other and equal counts of them.
RenderOptions lineOf(const SuitePicture& p, bool golden) {
    std::vector<std::string> line = {"render",
                                     p.scene,
                                     "-o",
                                     "picture.exr",
                                     "-r",
                                     std::to_string(p.width),
                                     std::to_string(p.height),
                                     "-s",
                                     std::to_string(golden ? p.goldenSamples : p.samples),
                                     "--even",
                                     "--branches",
                                     "1"};
    const auto states = [&](const std::string& option) {
        return std::ranges::any_of(p.options, [&](const std::string& word) {
            return word == option || word.starts_with(option + "=");
        });
    };
    if (states("--seed"))
        throw UsageError("--seed is the suite's: golden pictures and those that they judge must "
                         "have different samples");
    if (!states("--sampler")) line.insert(line.end(), {"--sampler", "independent"});
    if (golden) line.insert(line.end(), {"--seed", std::to_string(kGoldenSeed)});
    line.insert(line.end(), p.options.begin(), p.options.end());
    const std::optional<ParsedCommand> parsed = parseOptions(line);
    const RenderOptions* options = parsed ? std::get_if<RenderOptions>(&parsed->options) : nullptr;
    if (!options || options->pixelAlone || options->sequence.isGiven() ||
        !options->cameras.empty() || options->share.share ||
        options->picture.denoiser != Denoiser::Off || !options->device.device.empty())
        throw UsageError(fmt::format("a suite's pictures are single ones, all on one device and "
                                     "judged with their noise: {}",
                                     fmt::join(p.options, " ")));
    return *options;
}

/// The most memory that this process has had since the last call, in 10^6 bytes; 0 where the system
/// does not say.
double takePeakMegabytes() {
    double kilobytes = 0;
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) kilobytes = std::stod(line.substr(6));
    std::ofstream("/proc/self/clear_refs") << "5\n"; // begins to count anew (Linux, proc(5))
    return kilobytes * 1024e-6;
}

/// Renders pictures one after the other on one device.
class Maker {
  public:
    explicit Maker(const DeviceRequest& device) : session_(device, toTerminal()) {}

    /// Throws Error. The session has the picture's pixels until the next one.
    Film make(const SuitePicture& p, bool golden) {
        const RenderOptions options = lineOf(p, golden);
        const LoadedScene scene = loadScene(options.scene, toTerminal());
        ProgressBar bar;
        SessionEvents events;
        events.progress = [&bar](const RenderProgress& progress) {
            bar.show(progress);
            return interrupted() ? Next::Cancel : Next::GoOn;
        };
        session_.begin(scene.scene, options.picture);
        if (session_.run(events).bands > 1)
            throw UsageError("the film does not fit the memory: give another size");
        return session_.film();
    }
    FloatImage withStatistics() { return session_.pixels(true); }
    std::string device() const { return session_.result().backend; }

  private:
    RenderSession session_;
};

bool isExr(const fs::path& file) {
    const std::string ending = file.extension().string();
    return ending == ".exr" || ending == ".EXR";
}

/// Makes the golden picture anew; the outcome compares it with the one before.
void update(Maker& maker, const SuitePicture& p, const fs::path& folder,
            regress::Outcome& outcome) {
    if (!isExr(p.golden))
        throw UsageError(p.golden.string() +
                         ": golden pictures that --update makes are .exr files");
    std::optional<compare::Picture> before;
    if (fs::exists(p.golden)) before = compare::readPicture(p.golden);
    const compare::Picture now = compare::pictureOf(maker.make(p, true));
    if (interrupted()) return;
    std::error_code failed;
    fs::create_directories(p.golden.parent_path(), failed);
    writeExr(p.golden.string(), maker.withStatistics());
    outcome.verdict = regress::Verdict::Updated;
    const bool comparable = before && before->width == now.width && before->height == now.height;
    if (comparable) outcome.comparison = compare::comparePictures(*before, now, {});
    writePictures(folder, comparable ? *before : now, now, outcome);
}

void test(Maker& maker, const SuitePicture& p, double falseAlarms, const fs::path& folder,
          regress::Outcome& outcome) {
    std::optional<compare::Picture> golden;
    if (fs::exists(p.golden)) golden = compare::readPicture(p.golden);
    const compare::Picture picture = compare::pictureOf(maker.make(p, false));
    if (interrupted()) return;
    writeExr((folder / (p.name + ".exr")).string(), maker.withStatistics());
    if (!golden) {
        outcome.verdict = regress::Verdict::NoGolden;
        outcome.reasons = {fmt::format("there is no {} (--update makes it)", p.golden.string())};
        return;
    }
    judge(*golden, picture, falseAlarms, outcome);
    writePictures(folder, *golden, picture, outcome);
}

void writeSuiteReports(const fs::path& folder, const regress::Results& results) {
    const auto write = [&](const char* name, const std::string& text) {
        writeFileAtomically(folder / name, std::as_bytes(std::span(text)));
    };
    write("results.json", regress::toJson(results).dump(2) + "\n");
    write("junit.xml", regress::toJunit(results));
    write("report.html", regress::toPage(results, folder));
}

/// One picture after the other, until the user interrupts. One that cannot be made costs itself.
void runAll(const RegressOptions& o, const std::vector<SuitePicture>& pictures,
            regress::Results& results) {
    Maker maker(o.device);
    const fs::path folder = o.folder;
    for (const SuitePicture& p : pictures) {
        regress::Outcome& outcome = results.outcomes.emplace_back(regress::Outcome{.which = p});
        if (interrupted()) continue;
        nowDoing(
            fmt::format("picture {} of {}: {}", results.outcomes.size(), pictures.size(), p.name),
            StatusLine::OfOthers);
        takePeakMegabytes();
        const Stopwatch watch;
        try {
            if (o.update)
                update(maker, p, folder, outcome);
            else
                test(maker, p, results.pictureFalseAlarms, folder, outcome);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::DeviceLost || error.kind() == ErrorKind::Output) throw;
            outcome.verdict = regress::Verdict::Failed;
            outcome.reasons = {error.what()};
        }
        outcome.seconds = watch.seconds();
        outcome.megabytes = takePeakMegabytes();
        noteBudgets(outcome);
    }
    results.device = maker.device();
}

} // namespace

int regressCommand(const RegressOptions& o) {
    regress::Results results;
    results.suite = regress::readSuite(o.suite);
    const std::vector<SuitePicture> pictures = regress::chosen(results.suite, o.only);
    std::error_code failed;
    fs::create_directories(o.folder, failed);
    checkFileWritable(fs::path(o.folder) / "results.json");
    onSignal(OnSignal::Ask);
    results.pictureFalseAlarms = falseAlarmsOfEach(results.suite);
    results.version = version();
    results.date = bench::circumstancesOf({}, {}, 0, "").date;
    runAll(o, pictures, results);
    writeSuiteReports(o.folder, results);
    fmt::print("{}", regress::toText(results));
    if (o.verbosity != Verbosity::ErrorsOnly)
        fmt::print("report: {}\n", (fs::path(o.folder) / "report.html").string());
    if (interrupted()) {
        logging::warn("interrupted: the pictures that were done are in the report");
        return interruptedExitCode();
    }
    if (results.failed()) return int(ExitCode::Device);
    return results.passed() ? int(ExitCode::Success) : int(ExitCode::TooFewSamples);
}

} // namespace stromboli
