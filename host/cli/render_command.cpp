#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/going_on.hpp"
#include "host/cli/job.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/cli/renderer.hpp"
#include "host/cli/report.hpp"
#include "host/cli/seen_channels.hpp"
#include "host/cli/sequence.hpp"
#include "host/cli/share_render.hpp"
#include "host/cli/signals.hpp"
#include "host/cli/views.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/stopwatch.hpp"
#include "host/farm/plan_file.hpp"
#include "host/film/unreached.hpp"
#include "host/render/bands.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/noise_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

/// Of all bands.
struct Progress {
    uint64_t pixelsDone = 0, pixels = 0, samplesDone = 0, bandPixels = 0;
    ProgressBar bar;

    void show(RenderProgress state) {
        state.samplesDone += samplesDone;
        state.share = (double(pixelsDone) + state.share * double(bandPixels)) / double(pixels);
        bar.show(state);
    }
};

/// The time that is left, shared by rows with the bands to come.
RenderSettings settingsOf(const RenderSettings& all, const PictureArea& band, double secondsUsed,
                          uint64_t pixelsLeft) {
    RenderSettings settings = all;
    settings.area = band;
    double& seconds = settings.budget.stop.seconds;
    if (seconds > 0 && band.pixelCount() < pixelsLeft)
        seconds = std::max((seconds - secondsUsed) * double(band.pixelCount()) / double(pixelsLeft),
                           1e-3); // it begins at least
    return settings;
}

void addTo(RenderReport& report, const KeptOutcome& kept) {
    report.prepareSeconds += kept.prepareSeconds;
    report.renderSeconds += kept.renderSeconds;
    report.counters.paths += kept.counters.paths;
    report.counters.rays += kept.counters.rays;
    report.interrupted = kept.stopped;
    report.lost = kept.lost;
}

/// Alpha and layers of a band; a device that is lost sees nothing.
FloatImage lookAround(const KeptOutcome& kept, const Job& job, const Options& options,
                      Viewer* viewer) {
    if (seenChannelNames(options).empty()) return {};
    nowDoing("tracing alpha and layers");
    FloatImage seen = seenChannels(kept.lost ? nullptr : viewer, kept.film, job, options);
    nowDoing("taking samples", StatusLine::OfOthers);
    return seen;
}

/// The backend, adding up blocks where the settings ask for it.
MakeBackend inBlocks(const MakeBackend& makeBackend) {
    return [&makeBackend](const RenderSettings& settings, bool again) -> std::shared_ptr<Backend> {
        std::shared_ptr<Backend> backend = makeBackend(settings, again);
        if (!settings.budget.isInBlocks()) return backend;
        return std::make_shared<BlockBackend>(std::move(backend), settings.area,
                                              settings.budget.samplesPerBlock);
    };
}

/// Samples until the picture is there, with checkpoints, band by band.
void takeSamples(const Job& job, const Options& options, const Begun& begun,
                 const MakeBackend& makeBackend, const std::function<Viewer*()>& viewer,
                 uint64_t mostPixels, RenderOutputs& outputs, RenderReport& report) {
    const std::vector<PictureArea> bands = bandsToRender(job.settings.area, mostPixels, begun);
    bool alone = begun.checkpoint.has_value(); // no checkpoint of an earlier render is in the way
    double secondsBefore = 0;                  // of the bands that were done in earlier runs
    Progress progress;
    progress.pixels = job.settings.area.pixelCount();
    nowDoing("taking samples", StatusLine::OfOthers);
    for (size_t i = 0; i < bands.size(); ++i) {
        const PictureArea& band = bands[i];
        if (report.interrupted || report.lost) {
            outputs.leaveOut(band);
            report.pixelsUnreached += band.pixelCount();
            continue;
        }
        progress.bandPixels = band.pixelCount();
        KeptRender render =
            keptRender(job,
                       settingsOf(job.settings, band, secondsBefore + report.renderSeconds,
                                  progress.pixels - progress.pixelsDone),
                       options, begunBand(begun, i, bands.size()), report.backend);
        if (render.begun) secondsBefore += render.begun->secondsUsed;
        if (bands.size() > 1) render.keepsAtEnd = !render.file.empty(); // until all are done
        render.identity = [&, identity = std::move(render.identity)] {
            if (!alone) forgetEarlier(begun.file, bands.size());
            alone = true;
            return identity();
        };
        KeptOutcome kept = renderKept(
            render, inBlocks(makeBackend),
            [&](const RenderProgress& state) {
                if (state.samplesDone > 0) onSignal(OnSignal::AskToKeep);
                progress.show(state);
                return !interrupted();
            },
            [](const std::string& line) { logging::warn(line); });
        addTo(report, kept);
        if (kept.fileIsThere) report.checkpoint = render.file.string();
        count(kept.film, render.settings, report);
        const FloatImage more = lookAround(kept, job, options, viewer());
        showNeighbours(kept.film, NoisePlan::kCoarsest);
        outputs.place(kept.film, kept.outcome.noise, more);
        progress.pixelsDone += band.pixelCount();
        progress.samplesDone = report.samplesTaken / job.settings.estimator.branches;
    }
    report.bands = bands.size();
}

void sayHowToGoOn(const RenderReport& report) {
    if (!report.checkpoint.empty())
        logging::warn(
            fmt::format("the same command with --resume goes on from {}", report.checkpoint));
}

int reportLoss(const RenderReport& report, const Options& options) {
    logging::error(fmt::format("{}, twice; {} holds the samples that were taken", *report.lost,
                               options.output));
    sayHowToGoOn(report);
    return int(ExitCode::Device);
}

int reportInterruption(const RenderReport& report, const Job& job, const Options& options) {
    if (job.settings.budget.stop.open())
        logging::warn(
            fmt::format("interrupted: {} holds the samples that were taken", options.output));
    else
        logging::warn(fmt::format(
            "interrupted: {} holds the {:.1f} % of the samples that were taken", options.output,
            100.0 * double(report.samplesTaken) / double(report.samplesAtMost)));
    sayHowToGoOn(report);
    return interruptedExitCode();
}

/// Returns the exit code.
int renderPicture(Renderer& renderer, Job& job, const Options& asked, const Begun& begun) {
    const Options options = optionsToGoOn(asked, begun);
    setPicture(job, options);
    checkDiskSpace(job, options);
    RenderOutputs outputs(job, options);
    RenderReport report;
    report.loadSeconds = job.loadSeconds;
    renderer.render(
        job, options,
        [&](const MakeBackend& makeBackend, const std::function<Viewer*()>& viewer,
            uint64_t mostPixels, RenderReport& r) {
            takeSamples(job, options, begun, makeBackend, viewer, mostPixels, outputs, r);
        },
        report);
    report.noise = outputs.noise();
    report.samplesAtMost = mostPathsOf(job.settings);
    nowDoing("writing " + options.output);
    const Stopwatch writing;
    outputs.write(report);
    if (report.bands > 1 && !report.interrupted && !report.lost && options.checkpointFile.empty())
        forgetEarlier(begun.file, report.bands);
    report.writeSeconds = writing.seconds();
    logReport(report, job.settings);
    logBrightness(outputs.brightness(), job, options);
    if (report.lost) return reportLoss(report, options);
    return report.interrupted ? reportInterruption(report, job, options) : 0;
}

/// At another moment of its file. Where nothing but the camera has moved, the scene is kept as it
/// is built and uploaded.
void moveTo(const Options& frame, Job& job, Renderer& renderer) {
    job = loadMoment(frame, job);
    if (job.scene.isMoment()) renderer.changeScene();
}

/// Part of the samples of all pixels, or of a plan, as a film. Returns the exit code.
int renderShare(Renderer& renderer, Job& job, const Options& options) {
    setPicture(job, options);
    requireExpected(job, options);
    std::optional<RoundPlan> plan;
    if (!options.planFile.empty()) plan = readPlan(options.planFile);
    RenderReport report;
    report.loadSeconds = job.loadSeconds;
    report.isShare = true;
    bool isThere = false;
    renderer.render(
        job, options,
        [&](const MakeBackend& makeBackend, const std::function<Viewer*()>& viewer,
            uint64_t mostPixels, RenderReport& r) {
            const PlannedShare share = shareToTake(job, options, plan, r.backend);
            isThere = isThereAlready(share.header, options);
            if (!isThere) takeShare(job, options, share, makeBackend, viewer, mostPixels, r);
        },
        report);
    if (isThere) return 0;
    if (report.interrupted) {
        logging::warn(fmt::format("interrupted: {} is not written", options.output));
        return interruptedExitCode();
    }
    logReport(report, job.settings);
    if (!options.statsFile.empty()) writeStatistics(options.statsFile, report, job);
    return 0;
}

/// One after the other, until one is not finished.
int renderPictures(Renderer& renderer, Job& job, const std::vector<Options>& pictures) {
    for (const Options& picture : pictures)
        checkOutputs(picture); // before the first takes its time
    for (size_t i = 0; i < pictures.size(); ++i) {
        logging::info(fmt::format("{} ({} of {})", pictures[i].output, i + 1, pictures.size()));
        if (i > 0 && pictures[i].reading.selection.isFrame) moveTo(pictures[i], job, renderer);
        const int code = renderPicture(renderer, job, pictures[i], takeUp(pictures[i]));
        if (code != 0 && i + 1 < pictures.size())
            logging::warn(fmt::format("the other {} of the {} pictures are left out",
                                      pictures.size() - i - 1, pictures.size()));
        if (code != 0) return code;
        job.loadSeconds = 0; // was the first one's
    }
    return 0;
}

} // namespace

int renderCommand(const Options& asked) {
    const bool several = !asked.cameras.empty() || asked.sequence.isGiven();
    Begun begun;
    if (!several) checkOutputs(asked);
    if (!several && !asked.share) begun = takeUp(asked);
    Renderer renderer(asked);
    if (asked.sequence.isGiven()) {
        const std::vector<Options> frames = optionsOfFrames(asked);
        Job job = loadJob(frames.front());
        return renderPictures(renderer, job, frames);
    }
    Job job = loadJob(asked);
    if (asked.share) return renderShare(renderer, job, asked);
    if (!several) return renderPicture(renderer, job, asked, begun);
    return renderPictures(renderer, job, optionsOfPictures(asked, job.scene));
}

} // namespace stromboli
