// `render` with --share: part of the samples of all pixels, as a film.
#include "host/cli/share_render.hpp"

#include "host/checkpoint/scene_identity.hpp"
#include "host/cli/activity.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/farm/film_file.hpp"
#include "host/render/bands.hpp"
#include "host/render/block_backend.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

namespace stromboli {
namespace {

std::vector<PixelTarget> allPixels(const PictureArea& area, uint32_t samples) {
    std::vector<PixelTarget> targets(area.pixelCount());
    for (uint32_t i = 0; i < targets.size(); ++i)
        targets[i] = {i, samples};
    return targets;
}

/// How far the samples of all bands are.
struct ShareProgress {
    uint64_t samples = 0, done = 0; ///< of all bands; before the block under way
    ProgressBar bar;

    bool show(const Backend& backend, uint64_t doneOfBlock) {
        RenderProgress state;
        state.samplesAtMost = samples;
        state.samplesDone = done + doneOfBlock;
        state.counters = backend.counters();
        state.share = double(state.samplesDone) / double(samples);
        bar.show(state);
        return !interrupted();
    }
};

/// The blocks of a band of the picture; nothing if it was interrupted.
std::optional<BlockSums> takeBlocks(Backend& backend, const PictureArea& band,
                                    const FilmHeader& header, ShareProgress& progress) {
    BlockSums sums;
    const SampleBlocks all = header.allBlocks();
    for (const BlockRange& range : header.blocks)
        for (uint32_t block = range.first; block < range.end; ++block) {
            const uint32_t first = all.firstOf(block), samples = all.firstOf(block + 1) - first;
            Film film(band);
            bool goesOn = true;
            backend.beginAt(first);
            backend.sample(allPixels(band, samples), film, [&](uint64_t done) {
                return goesOn = progress.show(backend, done) && goesOn;
            });
            if (!goesOn) return std::nullopt;
            sums.add(film, first);
            progress.done += band.pixelCount() * samples;
        }
    return sums;
}

Film filmOf(const PictureArea& band, const BlockSums& sums) {
    Film film(band);
    for (size_t i = 0; i < film.pixels.size(); ++i)
        film.pixels[i] = sums.pixels()[i].statistics();
    return film;
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
    return picture;
}

FilmHeader headerOfShare(const Job& job, const Options& options, const std::string& device) {
    FilmHeader picture = headerOfPicture(job, options, device);
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
    return ofShare(std::move(picture), *options.share);
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
    if (difference.empty() && film->header().shares != header.shares)
        difference = "is of other shares";
    if (!difference.empty())
        throw UsageError(fmt::format("{} {}; --resume keeps films of this share only",
                                     options.output, difference));
    logging::info(fmt::format("{} is there already", options.output));
    return true;
}

void takeShare(const Job& job, const Options& options, const FilmHeader& header,
               const MakeBackend& makeBackend, uint64_t mostPixels, RenderReport& report) {
    FilmWriter writer(options.output, header);
    ShareProgress progress;
    progress.samples = job.settings.area.pixelCount() * header.samples();
    report.samplesAtMost = progress.samples * job.settings.estimator.branches;
    onSignal(OnSignal::Ask);
    std::vector<PictureArea> bands = bandsOf(job.settings.area, mostPixels);
    if (header.blocks.empty()) bands.clear();
    for (const PictureArea& band : bands) {
        RenderSettings settings = job.settings;
        settings.area = band;
        const Stopwatch preparing;
        const std::shared_ptr<Backend> backend = makeBackend(settings, false);
        report.prepareSeconds += preparing.seconds();
        nowDoing("taking samples", StatusLine::OfOthers);
        const Stopwatch rendering;
        const std::optional<BlockSums> sums = takeBlocks(*backend, band, header, progress);
        report.renderSeconds += rendering.seconds();
        const RenderCounters counters = backend->counters();
        report.counters.paths += counters.paths;
        report.counters.rays += counters.rays;
        report.interrupted = !sums;
        if (!sums) return;
        count(filmOf(band, *sums), settings, report);
        writer.add(sums->pixels());
    }
    report.bands = bands.size();
    nowDoing("writing " + options.output);
    const Stopwatch writing;
    writer.finish();
    report.writeSeconds = writing.seconds();
}

} // namespace stromboli
