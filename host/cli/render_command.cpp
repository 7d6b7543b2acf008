#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/going_on.hpp"
#include "host/cli/job.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/cli/report.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/memory.hpp"
#include "host/core/stopwatch.hpp"
#include "host/film/unreached.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/bands.hpp"
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

/// Samples until the picture is there, with checkpoints, band by band.
void takeSamples(const Job& job, const Options& options, const Begun& begun,
                 const MakeBackend& makeBackend, uint64_t mostPixels, RenderOutputs& outputs,
                 RenderReport& report) {
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
            render, makeBackend,
            [&](const RenderProgress& state) {
                if (state.samplesDone > 0) onSignal(OnSignal::AskToKeep);
                progress.show(state);
                return !interrupted();
            },
            [](const std::string& line) { logging::warn(line); });
        addTo(report, kept);
        if (kept.fileIsThere) report.checkpoint = render.file.string();
        count(kept.film, render.settings, report);
        showNeighbours(kept.film, NoisePlan::kCoarsest);
        outputs.place(kept.film, kept.outcome.noise);
        progress.pixelsDone += band.pixelCount();
        progress.samplesDone = report.samplesTaken / job.settings.estimator.branches;
    }
    report.bands = bands.size();
}

/// As many as half of the host's memory, and the device's, have room for.
uint64_t pixelsThatFit(const Options& options, uint64_t onDevice, uint64_t deviceBytesPerPixel) {
    const uint64_t memory =
        options.filmMebibytes ? uint64_t(*options.filmMebibytes) << 20 : physicalMemory() / 2;
    return std::min(memory / (hostBytesPerPixel() + deviceBytesPerPixel), onDevice);
}

void renderOnDevice(const Job& job, std::future<vulkan::OpenDevice> device, const Options& options,
                    const Begun& begun, RenderOutputs& outputs, RenderReport& report) {
    const BuiltScene built = buildScene(job);
    report.buildSeconds = built.buildSeconds;
    vulkan::OpenDevice open = device.get();
    const vulkan::DeviceDescription& description = open.device->description();
    report.backend = description.name();
    logging::debug(
        fmt::format("device {}: {} ({})", open.choice.index, report.backend, open.choice.reason));
    const uint64_t mostPixels = pixelsThatFit(
        options, filmPixelsThatFit(description, built.gpu, job.settings.estimator.branches),
        description.isCpu() ? sizeof(gpu::PixelState) : 0);
    bool first = true;
    const auto makeBackend = [&](const RenderSettings& settings, bool again) {
        if (again) open = vulkan::openDevice(options.device); // the last one is lost
        auto backend =
            std::make_unique<VulkanBackend>(*open.device, built.gpu, job.camera, settings);
        for (const std::string& line : describe(backend->features()))
            if (first) logging::debug(fmt::format("kernel: {}", line));
        first = false;
        return backend;
    };
    takeSamples(job, options, begun, makeBackend, mostPixels, outputs, report);
    vulkan::requireNoValidationMessages(open);
}

void renderOnReference(const Job& job, const Options& options, const Begun& begun,
                       RenderOutputs& outputs, RenderReport& report) {
    report.backend = "CPU reference (double precision)";
    takeSamples(
        job, options, begun,
        [&](const RenderSettings& settings, bool) {
            return std::make_unique<ReferenceBackend>(job.scene, job.camera, settings,
                                                      options.threads);
        },
        pixelsThatFit(options, ~uint64_t(0), 0), outputs, report);
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

} // namespace

int renderCommand(const Options& asked) {
    checkOutputs(asked);
    const Begun begun = takeUp(asked);
    const Options options = optionsToGoOn(asked, begun);
    const bool onDevice = options.backend == BackendChoice::Vulkan;
    std::future<vulkan::OpenDevice> device;
    if (onDevice) device = openDeviceMeanwhile(options);
    const Job job = prepareJob(options);
    checkDiskSpace(job, options);
    RenderOutputs outputs(job, options);
    RenderReport report;
    report.loadSeconds = job.loadSeconds;
    if (onDevice)
        renderOnDevice(job, std::move(device), options, begun, outputs, report);
    else
        renderOnReference(job, options, begun, outputs, report);
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

} // namespace stromboli
