// `render` with --share: part of the samples of all pixels, or of a plan, as a film.
#include "host/cli/share_render.hpp"

#include "host/checkpoint/scene_identity.hpp"
#include "host/cli/activity.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/seen_channels.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/printable.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/shared_band.hpp"
#include "host/render/bands.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

namespace stromboli {
namespace {

/// How far the samples of all bands are.
struct ShareProgress {
    uint64_t samples = 0, done = 0; ///< of all bands
    ProgressBar bar;

    /// So many more samples are done.
    bool show(const Backend& backend, uint64_t more) {
        done += more;
        RenderProgress state;
        state.samplesAtMost = samples;
        state.samplesDone = done;
        state.counters = backend.counters();
        state.share = double(state.samplesDone) / double(samples);
        bar.show(state);
        return !interrupted();
    }
};

/// Those of the pixels that lie in a band of so many pixels.
std::span<const PlannedPixel> inBand(std::span<const PlannedPixel> pixels, uint32_t firstPixel,
                                     uint64_t count) {
    const auto begin = std::ranges::lower_bound(pixels, firstPixel, {}, &PlannedPixel::pixel);
    const auto end = std::ranges::lower_bound(pixels, firstPixel + count, {}, &PlannedPixel::pixel);
    return {begin, end};
}

} // namespace

std::string fingerprintOf(const Job& job) {
    return fmt::format("{:08x}-{}", sceneIdentity(job.scene, job.camera), renderingCode());
}

void requireExpected(const Job& job, const Options& options) {
    const std::string here = fingerprintOf(job);
    if (options.expected.empty() || options.expected == here) return;
    const auto refuse = [&](const std::string& what) {
        throw SceneError(fmt::format("{}: {}: its fingerprint is {} here, and {} was expected",
                                     options.scene, what, here, options.expected));
    };
    if (options.expected.size() != here.size()) refuse("--expect names no fingerprint");
    if (options.expected.substr(0, 8) != here.substr(0, 8))
        refuse("the scene or its camera is not the one that was submitted");
    refuse(fmt::format("this build of the program, {}, takes other samples than the one that "
                       "submitted it",
                       version()));
}

FilmHeader headerOfPicture(const Job& job, const Options& options, const std::string& device) {
    // Films count the samples that a surface covers; those of such filters have weights.
    if (options.transparent && hasNegativeLobes(job.settings.estimator.filter))
        throw UsageError(fmt::format("shares have no --transparent with the pixel filter {}, which "
                                     "is negative in places: --filter box has it",
                                     nameOf(job.settings.estimator.filter)));
    FilmHeader picture;
    picture.identity = {version(),
                        renderingCode(),
                        job.scene.file,
                        sceneIdentity(job.scene, job.camera),
                        std::string(nameOf(options.backend)),
                        device};
    picture.settings = job.settings;
    picture.scene = options.scene;
    picture.command = options.pictureCommand;
    picture.layers = options.layers;
    for (const PictureNote& note : legendOf(options.layers, job.scene))
        picture.legend.push_back({note.name, printable(note.text)});
    return picture;
}

PlannedShare shareToTake(const Job& job, const Options& options,
                         const std::optional<RoundPlan>& plan, const std::string& device) {
    FilmHeader picture = headerOfPicture(job, options, device);
    if (plan) {
        const std::string difference = differenceOf(picture, plan->picture);
        if (!difference.empty())
            throw UsageError(fmt::format("{} {}", options.planFile, difference));
        picture.planned = plan->picture.planned;
        PlannedShare share = ofShare({std::move(picture), plan->from, plan->to}, *options.share);
        if (share.pixels.empty())
            logging::warn(fmt::format("{} has no samples for share {}", options.planFile,
                                      inWords(*options.share)));
        return share;
    }
    const uint32_t blocks = picture.allBlocks().count();
    if (blocks < options.share->count)
        logging::warn(
            fmt::format("the {} samples a pixel are {} of {}: only {} of {} shares have any; "
                        "--block N, of less, "
                        "makes more",
                        mostPathsOf(job.settings) / job.settings.area.pixelCount(),
                        blocks == 1 ? "a block" : fmt::format("{} blocks", blocks),
                        job.settings.budget.samplesPerBlock * job.settings.estimator.branches,
                        blocks, options.share->count));
    return {ofShare(std::move(picture), *options.share), {}};
}

bool isThereAlready(const FilmHeader& header, const Options& options) {
    if (!options.resume || !std::filesystem::exists(options.output)) return false;
    std::optional<FilmReader> film;
    try {
        film.emplace(options.output);
    } catch (const UsageError& error) {
        logging::warn(fmt::format("{}; the share is taken anew", error.what()));
        return false;
    }
    std::string difference = differenceOf(header, film->header());
    if (difference.empty() && film->header().rounds() != header.rounds())
        difference =
            fmt::format("is of round {}, not of {}", film->header().rounds(), header.rounds());
    else if (difference.empty() && !holdTheSame(header, film->header()))
        difference = "is of other shares";
    if (!difference.empty())
        throw UsageError(fmt::format("{} {}; --resume keeps films of this share only",
                                     options.output, difference));
    logging::info(fmt::format("{} is there already", options.output));
    return true;
}

void takeShare(const Job& job, const Options& options, const PlannedShare& share,
               const MakeBackend& makeBackend, const std::function<Viewer*()>& viewer,
               uint64_t mostPixels, RenderReport& report) {
    const FilmHeader& header = share.header;
    const bool isPlanned = !header.planned.empty();
    FilmWriter writer(options.output, header);
    ShareProgress progress;
    progress.samples = header.samplesHeld();
    report.samplesAtMost = progress.samples * job.settings.estimator.branches;
    onSignal(OnSignal::Ask);
    std::vector<PictureArea> bands = bandsOf(job.settings.area, mostPixels);
    if (header.isEmpty()) bands.clear();
    uint32_t firstPixel = 0; // of the band
    for (const PictureArea& band : bands) {
        const auto pixels = inBand(share.pixels, firstPixel, band.pixelCount());
        if (isPlanned && pixels.empty()) {
            writer.add(std::vector<SharedPixel>(band.pixelCount()));
            firstPixel += uint32_t(band.pixelCount());
            continue;
        }
        RenderSettings settings = job.settings;
        settings.area = band;
        const Stopwatch preparing;
        const std::shared_ptr<Backend> backend = makeBackend(settings, false);
        report.prepareSeconds += preparing.seconds();
        nowDoing("taking samples", StatusLine::OfOthers);
        const Stopwatch rendering;
        SharedBand taken(*backend, band,
                         [&](uint64_t more) { return progress.show(*backend, more); });
        if (header.hasAlpha()) taken.countCovered(viewer);
        report.interrupted = !(isPlanned ? taken.takePlanned(pixels, firstPixel, header.rounds())
                                         : taken.takeBlocks(header));
        report.renderSeconds += rendering.seconds();
        const RenderCounters counters = backend->counters();
        report.counters.paths += counters.paths;
        report.counters.rays += counters.rays;
        if (report.interrupted) return;
        const Film film = taken.film();
        count(film, settings, report);
        const std::vector<float> layers = header.holdsLayers
                                              ? layersByPixel(*viewer(), film, job, options)
                                              : std::vector<float>{};
        const Stopwatch writing;
        writer.add(taken.sums(), layers);
        report.writeSeconds += writing.seconds();
        firstPixel += uint32_t(band.pixelCount());
    }
    if (isPlanned) report.pixelsUnreached = 0; // by this share: others have samples of them
    report.bands = bands.size();
    nowDoing("writing " + options.output);
    const Stopwatch writing;
    writer.finish();
    report.writeSeconds += writing.seconds();
}

} // namespace stromboli
