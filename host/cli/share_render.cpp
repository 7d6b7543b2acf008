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
#include "host/farm/add_samples.hpp"
#include "host/farm/film_file.hpp"
#include "host/render/bands.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <span>

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
    uint64_t samples = 0, done = 0; ///< of all bands; before those under way
    ProgressBar bar;

    bool show(const Backend& backend, uint64_t underWay) {
        RenderProgress state;
        state.samplesAtMost = samples;
        state.samplesDone = done + underWay;
        state.counters = backend.counters();
        state.share = double(state.samplesDone) / double(samples);
        bar.show(state);
        return !interrupted();
    }
};

/// Part of a picture, and what the films of shares have of it.
class SharedBand {
  public:
    SharedBand(Backend& backend, const PictureArea& band, ShareProgress& progress)
        : backend_(backend), band_(band), progress_(progress), sums_(band.pixelCount()) {}

    /// For pictures with alpha: the samples whose camera rays end on a surface are counted, by the
    /// viewer that there is then (of several devices, one may have dropped out).
    void countCovered(const std::function<Viewer*()>& viewer) { viewer_ = viewer; }

    /// The targets' samples from number `first` on. False if it was interrupted.
    bool take(uint32_t first, std::span<const PixelTarget> targets, uint32_t pass) {
        Film film(band_);
        bool goesOn = true;
        backend_.beginAt(first);
        backend_.sample(targets, film, [&](uint64_t done) {
            return goesOn = progress_.show(backend_, done) && goesOn;
        });
        if (!goesOn) return false;
        addSamples(sums_, targets, film, first, pass);
        for (const PixelTarget& t : targets)
            progress_.done += t.samples;
        if (viewer_) addCovered(first, targets);
        return true;
    }
    /// The blocks of a share of the first round.
    bool takeBlocks(const FilmHeader& header) {
        const SampleBlocks all = header.allBlocks();
        for (const BlockRange& range : header.blocks)
            for (uint32_t block = range.first; block < range.end; ++block) {
                const uint32_t first = all.firstOf(block);
                const uint32_t samples = all.firstOf(block + 1) - first;
                if (!take(first, allPixels(band_, samples), header.passOf(block))) return false;
            }
        return true;
    }
    /// What a share of a planned round has here; `firstPixel`: of the band, in the picture. Pixels
    /// that have as many samples until now go together: there are few such numbers.
    bool takePlanned(std::span<const PlannedPixel> pixels, uint32_t firstPixel, uint32_t pass) {
        std::map<uint32_t, std::vector<PixelTarget>> alike;
        for (const PlannedPixel& p : pixels)
            alike[p.from].push_back({p.pixel - firstPixel, p.to - p.from});
        for (const auto& [first, targets] : alike)
            if (!take(first, targets, pass)) return false;
        return true;
    }

    const std::vector<SharedPixel>& sums() const { return sums_; }
    Film film() const {
        Film film(band_);
        for (size_t i = 0; i < sums_.size(); ++i)
            film.pixels[i] = sums_[i].all.statistics();
        return film;
    }

  private:
    /// By the camera rays of the very samples.
    void addCovered(uint32_t firstSample, std::span<const PixelTarget> targets) {
        std::vector<uint32_t> samples(sums_.size(), 0);
        for (const PixelTarget& t : targets)
            samples[t.pixel] = t.samples;
        for (size_t begin = 0; begin < samples.size(); begin += Viewer::kMostSeenAtOnce) {
            const std::span<const uint32_t> run = std::span(samples).subspan(
                begin, std::min<size_t>(Viewer::kMostSeenAtOnce, samples.size() - begin));
            if (std::ranges::count(run, 0u) == std::ssize(run)) continue;
            const auto seen = viewer_()->see(uint32_t(begin), run, Seeing::Coverage, firstSample);
            for (size_t i = 0; i < seen.size(); ++i)
                sums_[begin + i].covered += seen[i].hits;
        }
    }

    Backend& backend_;
    PictureArea band_;
    ShareProgress& progress_;
    std::function<Viewer*()> viewer_; ///< none: no alpha
    std::vector<SharedPixel> sums_;
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
        SharedBand taken(*backend, band, progress);
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
        writer.add(taken.sums(), header.holdsLayers ? layersByPixel(*viewer(), film, job, options)
                                                    : std::vector<float>{});
        firstPixel += uint32_t(band.pixelCount());
    }
    if (isPlanned) report.pixelsUnreached = 0; // by this share: others have samples of them
    report.bands = bands.size();
    nowDoing("writing " + options.output);
    const Stopwatch writing;
    writer.finish();
    report.writeSeconds = writing.seconds();
}

} // namespace stromboli
