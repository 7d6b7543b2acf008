// `render`: a picture, a share of one, or several.
#include "host/checkpoint/checkpoint_file.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/explain.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/cli/sequence.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "host/engine/render_session.hpp"
#include "host/engine/share.hpp"
#include "host/farm/round_plan.hpp"
#include "host/view/observer.hpp"
#include "host/view/server.hpp"
#include "host/view/tev.hpp"
#include "host/view/watching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

namespace stromboli {
namespace {

/// Events of a picture whose progress is shown, and which signals end.
SessionEvents watched(ProgressBar& bar) {
    SessionEvents events;
    events.progress = [&bar](const RenderProgress& state) {
        if (state.samplesDone > 0) onSignal(OnSignal::AskToKeep);
        bar.show(state);
        return interrupted() ? Next::Cancel : Next::GoOn;
    };
    return events;
}

/// Who looks at the render while it goes on, by what the options say.
struct Watchers {
    explicit Watchers(const RenderOptions& o) : observers(toTerminal().message) {
        if (o.watch.port) {
            view::ServerOptions serving;
            serving.port = uint16_t(*o.watch.port);
            serving.readOnly = true;
            serving.tone.view = nameOf(o.tone.view);
            serving.tone.exposure =
                o.tone.metersExposure ? "auto" : fmt::format("{}", o.tone.curve.exposure);
            server.emplace(serving, exchange);
            observers.add(view::watching(exchange, o.scene.source));
            logging::info("watch the render at " + server->address());
        }
        if (!o.watch.updateFile.empty())
            observers.add(view::updatingFile(o.watch.updateFile, o.watch.updateSeconds, o.tone));
        if (!o.watch.tev.empty())
            observers.add(view::sendingToTev(o.watch.tev, o.scene.source, kTevSeconds));
    }

    static constexpr double kTevSeconds = 1; ///< from one picture to the next
    view::Exchange exchange;
    view::Observers observers;
    std::optional<view::Server> server; ///< ends first
};

/// Where the state of a render is kept; empty: nowhere.
std::string checkpointFileOf(const RenderOptions& options) {
    const std::string& asked = options.checkpoint.file;
    if (asked == "off" || options.output.file == "-") return {};
    return asked.empty() ? usualCheckpointPath(options.output.file).string() : asked;
}

/// Throws the UsageError that nothing tells which pictures are finished, where that is asked for.
void requireCheckpoints(const RenderOptions& options) {
    if (options.checkpoint.file != "off") return;
    if (options.checkpoint.resume)
        throw UsageError("--resume needs a checkpoint, and --checkpoint is off");
    if (options.skipExisting)
        throw UsageError("--skip-existing tells by checkpoints which pictures are not finished, "
                         "and --checkpoint is off");
}

/// Whether an earlier run has finished the picture.
bool isFinished(const RenderOptions& options) {
    return isFinishedPicture(options.output.file, checkpointFileOf(options));
}

/// Those of several pictures that are still to be rendered, where the options ask for no others.
std::vector<RenderOptions> unfinished(std::vector<RenderOptions> pictures) {
    const size_t all = pictures.size();
    std::erase_if(pictures, [](const RenderOptions& o) {
        return (o.checkpoint.resume || o.skipExisting) && isFinished(o);
    });
    if (pictures.size() < all)
        logging::info(
            fmt::format("{} of {} pictures are there already", all - pictures.size(), all));
    for (RenderOptions& o : pictures)
        if (!hasCheckpoint(checkpointFileOf(o)))
            o.checkpoint.resume = false; // of one that has not begun
    return pictures;
}

/// The checkpoint, and what it holds where --resume asks for it.
Keeping keepingOf(const RenderOptions& options) {
    const CheckpointOptions& asked = options.checkpoint;
    Keeping keeping;
    keeping.file = checkpointFileOf(options);
    keeping.everySeconds = asked.everySeconds;
    keeping.keepsAtEnd = !asked.file.empty() && !keeping.file.empty();
    if (!asked.resume) return keeping;
    if (keeping.file.empty()) throw UsageError("--resume needs a checkpoint, and -o - has none");
    return takeUp(keeping, toTerminal());
}

void sayHowToGoOn(const RenderResult& result) {
    if (!result.checkpoint.empty())
        logging::warn(
            fmt::format("the same command with --resume goes on from {}", result.checkpoint));
}

int reportLoss(const RenderResult& result, const std::string& file) {
    logging::error(
        fmt::format("{}, twice; {} holds the samples that were taken", *result.lost, file));
    sayHowToGoOn(result);
    return int(ExitCode::Device);
}

int reportInterruption(const RenderResult& result, const StopRule& stop, const std::string& file) {
    if (stop.open())
        logging::warn(fmt::format("interrupted: {} holds the samples that were taken", file));
    else
        logging::warn(
            fmt::format("interrupted: {} holds the {:.1f} % of the samples that were taken", file,
                        100.0 * double(result.samplesTaken) / double(result.samplesAtMost)));
    sayHowToGoOn(result);
    return interruptedExitCode();
}

/// Returns the exit code.
int renderPicture(RenderSession& session, const LoadedScene& scene, const RenderOptions& options,
                  const Keeping& keeping, view::Observers& observers) {
    session.begin(scene.scene, options.picture, keeping);
    const RenderSettings& settings = session.picture().settings;
    checkDiskSpace(*scene.scene, settings, options);
    RenderOutputs outputs(*scene.scene, settings, options);
    RenderReport report;
    report.loadSeconds = scene.seconds;
    {
        ProgressBar bar(options.progress);
        SessionEvents events = watched(bar);
        events.bandDone = [&](const FinishedBand& band) { outputs.place(band); };
        report.render = observers.run(session, events);
    }
    const RenderResult& result = report.render;
    const std::string& file = options.output.file;
    nowDoing("writing " + file);
    const Stopwatch writing;
    outputs.write(report);
    if (!result.cancelled && !result.lost && !keeping.keepsAtEnd) session.forgetBands();
    report.writeSeconds = writing.seconds();
    logReport(report, settings);
    logBrightness(outputs.brightness(), *scene.scene, file, options.tone);
    if (result.lost) return reportLoss(result, file);
    return result.cancelled ? reportInterruption(result, settings.budget.stop, file) : 0;
}

/// Part of the samples of all pixels, or of a plan, as a film. Returns the exit code.
int renderShare(const RenderOptions& options) {
    const Listener listener = toTerminal();
    Renderer renderer(options.device, listener); // opens the device while the scene is read
    const auto [scene, picture] = preparePicture(options);
    if (!options.share.expected.empty())
        requireFingerprint(options.share.expected, *scene.scene, picture.camera,
                           options.scene.source);
    ShareRequest share{*options.share.share,   {},
                       options.share.planFile, {options.scene.source, options.command},
                       options.output.file,    options.checkpoint.resume};
    if (!share.planFile.empty()) share.plan = readPlan(share.planFile);
    RenderReport report;
    report.loadSeconds = scene.seconds;
    report.isShare = true;
    bool wasThere = false;
    onSignal(OnSignal::Ask);
    {
        ProgressBar bar(options.progress);
        SessionEvents events;
        events.progress = [&bar](const RenderProgress& state) {
            bar.show(state);
            return interrupted() ? Next::Cancel : Next::GoOn;
        };
        const ShareResult taken =
            takeShare(renderer, scene.scene, picture, options.picture, share, events, listener);
        report.render = taken.render;
        report.writeSeconds = taken.writeSeconds;
        wasThere = taken.wasThere;
    }
    if (wasThere) return 0;
    if (report.render.cancelled) {
        logging::warn(fmt::format("interrupted: {} is not written", share.film));
        return interruptedExitCode();
    }
    logReport(report, picture.settings);
    if (!options.output.statsFile.empty())
        writeStatistics(options.output.statsFile, report, *scene.scene, picture.settings);
    return 0;
}

/// One after the other, until one is not finished.
int renderPictures(RenderSession& session, LoadedScene scene,
                   const std::vector<RenderOptions>& pictures, view::Observers& observers) {
    for (const RenderOptions& picture : pictures)
        checkOutputs(picture); // before the first takes its time
    for (size_t i = 0; i < pictures.size(); ++i) {
        const RenderOptions& picture = pictures[i];
        logging::info(fmt::format("{} ({} of {})", picture.output.file, i + 1, pictures.size()));
        if (i > 0 && picture.scene.reading.selection.isFrame)
            scene = loadMoment(picture.scene, std::move(scene), toTerminal());
        const int code = renderPicture(session, scene, picture, keepingOf(picture), observers);
        if (code != 0 && i + 1 < pictures.size())
            logging::warn(fmt::format("the other {} of the {} pictures are left out",
                                      pictures.size() - i - 1, pictures.size()));
        if (code != 0) return code;
        scene.seconds = 0; // was the first one's
    }
    return 0;
}

LoadedScene load(const SceneAndPicture& work) {
    LoadedScene scene = loadScene(work.scene, toTerminal());
    warnOfBlackPicture(*scene.scene, work.scene.source, work.picture, toTerminal());
    return scene;
}

} // namespace

PreparedPicture preparePicture(const SceneAndPicture& work) {
    PreparedPicture prepared{load(work), {}};
    prepared.picture = resolvePicture(*prepared.scene.scene, work.picture, toTerminal());
    return prepared;
}

int renderCommand(const RenderOptions& options) {
    if (options.pixelAlone) return explainPixel(options);
    requireCheckpoints(options);
    const bool several = !options.cameras.empty() || options.sequence.isGiven();
    if (!several && options.skipExisting && isFinished(options)) {
        logging::info(fmt::format("{} is there already", options.output.file));
        return 0;
    }
    if (!several) checkOutputs(options);
    if (options.share.share && options.sequence.isGiven()) {
        RenderOptions frame = optionsOfFrames(options).front(); // the only one
        frame.output.file = options.output.file;
        return renderShare(frame);
    }
    if (options.share.share) return renderShare(options);
    Keeping keeping;
    if (!several) keeping = keepingOf(options);
    RenderSession session(options.device, toTerminal()); // opens devices while the scene is read
    Watchers watchers(options);
    if (options.sequence.isGiven()) {
        const std::vector<RenderOptions> frames = unfinished(optionsOfFrames(options));
        if (frames.empty()) return 0;
        return renderPictures(session, load(frames.front()), frames, watchers.observers);
    }
    const LoadedScene scene = load(options);
    if (!several) return renderPicture(session, scene, options, keeping, watchers.observers);
    return renderPictures(session, scene, unfinished(optionsOfCameras(options, *scene.scene)),
                          watchers.observers);
}

} // namespace stromboli
