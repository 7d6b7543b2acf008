#include "host/cli/commands.hpp"
#include "host/cli/job.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/stopwatch.hpp"
#include "host/film/image_file.hpp"
#include "host/film/png.hpp"
#include "host/film/rate_picture.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/render.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

/// Whether a picture of its own shows how many samples each pixel has. Where they are spread
/// without being asked to, it would be a file that nobody asked for.
template <class AnyBudget>
bool showsRates(const AnyBudget& budget) {
    return budget.adaptive.enabled || budget.stop.open();
}

/// What the rate picture shows as full.
uint32_t mostSamples(const Film& film, const Budget& budget) {
    if (!budget.stop.open()) return budget.mostSamplesPerPixel;
    uint32_t most = 1;
    for (const PixelStatistics& p : film.pixels)
        most = std::max(most, p.taken());
    return most;
}

/// Output that cannot be written must be found out before the work, not after it.
void checkOutputs(const Options& options) {
    checkWritable(options.output);
    if (showsRates(options.budget)) checkFileWritable(ratePicturePath(options.output));
    if (options.statsFile.empty()) return;
    if (options.statsFile == options.output)
        throw UsageError("--stats and -o name the same file: " + options.output);
    checkFileWritable(options.statsFile);
}

Film takeSamples(Backend& backend, const Job& job, const Options& options, RenderReport& report) {
    Stopwatch watch;
    bool complete = true;
    RenderOutcome outcome;
    Film film = [&] {
        ProgressBar bar(options.verbosity != Verbosity::Quiet);
        const auto show = [&](const RenderProgress& progress) {
            bar.show(progress);
            complete = !interrupted();
            return complete;
        };
        return render(backend, job.settings, show, &outcome);
    }();
    RenderReport summary = summarise(film, job.settings);
    summary.backend = report.backend;
    summary.buildSeconds = report.buildSeconds;
    summary.loadSeconds = job.loadSeconds;
    summary.renderSeconds = watch.seconds();
    summary.counters = backend.counters();
    summary.noise = outcome.noise;
    summary.complete = complete;
    report = summary;
    return film;
}

Film renderOnDevice(const Job& job, std::future<vulkan::OpenDevice> device, const Options& options,
                    RenderReport& report) {
    const BuiltScene built = buildScene(job);
    report.buildSeconds = built.buildSeconds;
    const vulkan::OpenDevice open = device.get();
    report.backend = open.device->description().name();
    logging::debug(
        fmt::format("device {}: {} ({})", open.choice.index, report.backend, open.choice.reason));
    Film film;
    {
        VulkanBackend backend(*open.device, built.gpu, job.camera, job.settings);
        for (const std::string& line : describe(backend.features()))
            logging::debug(fmt::format("kernel: {}", line));
        film = takeSamples(backend, job, options, report);
    }
    vulkan::requireNoValidationMessages(open);
    return film;
}

Film renderOnReference(const Job& job, const Options& options, RenderReport& report) {
    report.backend = "CPU reference (double precision)";
    ReferenceBackend backend(job.scene, job.camera, job.settings, options.threads);
    return takeSamples(backend, job, options, report);
}

void writeOutputs(const Film& film, const Job& job, const Options& options,
                  const RenderReport& report) {
    PictureOptions picture;
    picture.tone = options.tone;
    picture.statistics = options.statisticsChannels;
    writePicture(options.output, film, job.settings.area.crop, picture);
    if (showsRates(job.settings.budget))
        writePng(ratePicturePath(options.output),
                 ratePicture(film, job.settings.area.crop, mostSamples(film, job.settings.budget)),
                 PngColorSpace::Unnamed);
    if (!options.statsFile.empty()) writeStatistics(options.statsFile, report, job);
}

} // namespace

int renderCommand(const Options& options) {
    checkOutputs(options);
    watchForInterrupt();
    const bool onDevice = options.backend == BackendChoice::Vulkan;
    std::future<vulkan::OpenDevice> device;
    if (onDevice) device = openDeviceMeanwhile(options);
    const Job job = prepareJob(options);
    RenderReport report;
    const Film film = onDevice ? renderOnDevice(job, std::move(device), options, report)
                               : renderOnReference(job, options, report);
    writeOutputs(film, job, options, report);
    logReport(report, film, job.settings);
    if (report.complete) return 0;
    if (job.settings.budget.stop.open())
        logging::warn(
            fmt::format("interrupted: {} holds the samples that were taken", options.output));
    else
        logging::warn(fmt::format(
            "interrupted: {} holds the {:.1f} % of the samples that were taken", options.output,
            100.0 * double(report.samplesTaken) / double(report.samplesAtMost)));
    return kInterruptedExitCode;
}

} // namespace stromboli
