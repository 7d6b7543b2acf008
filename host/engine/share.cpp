// Part of the samples of a picture, as a film.
#include "host/engine/share.hpp"

#include "host/checkpoint/scene_identity.hpp"
#include "host/core/error.hpp"
#include "host/core/printable.hpp"
#include "host/engine/render_result.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/round_plan.hpp"
#include "host/render/block_backend.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

namespace stromboli {
namespace {

/// Those of the pixels that lie in a band of so many pixels.
std::span<const PlannedPixel> inBand(std::span<const PlannedPixel> pixels, uint32_t firstPixel,
                                     uint64_t count) {
    const auto begin = std::ranges::lower_bound(pixels, firstPixel, {}, &PlannedPixel::pixel);
    const auto end = std::ranges::lower_bound(pixels, firstPixel + count, {}, &PlannedPixel::pixel);
    return {begin, end};
}

/// How many samples there are, said where shares have none of them.
void warnOfFewBlocks(const FilmHeader& film, const ShareName& share, const Listener& listener) {
    const RenderSettings& settings = film.settings;
    const uint32_t blocks = film.allBlocks().count();
    if (blocks >= share.count) return;
    listener.warn(fmt::format(
        "the {} samples a pixel are {} of {}: only {} of {} shares have any; --block "
        "N, of less, makes more",
        mostPathsOf(settings) / settings.area.pixelCount(),
        blocks == 1 ? "a block" : fmt::format("{} blocks", blocks),
        settings.budget.samplesPerBlock * settings.estimator.branches, blocks, share.count));
}

/// The share that is asked for: of the first round, in which no pixel is named, or of a plan. Says
/// so if it has no samples.
PlannedShare shareToTake(FilmHeader picture, const ShareRequest& request,
                         const Listener& listener) {
    if (!request.plan) {
        warnOfFewBlocks(picture, request.share, listener);
        return {ofShare(std::move(picture), request.share), {}};
    }
    const RoundPlan& plan = *request.plan;
    const std::string difference = differenceOf(picture, plan.picture);
    if (!difference.empty()) throw UsageError(fmt::format("{} {}", request.planFile, difference));
    picture.planned = plan.picture.planned;
    PlannedShare share = ofShare({std::move(picture), plan.from, plan.to}, request.share);
    if (share.pixels.empty())
        listener.warn(fmt::format("{} has no samples for share {}", request.planFile,
                                  inWords(request.share)));
    return share;
}

/// Whether the film is there already, from an earlier run. What cannot be read is said and taken
/// anew. Throws UsageError if it is of another picture or share.
bool isThereAlready(const FilmHeader& header, const ShareRequest& request,
                    const Listener& listener) {
    if (!request.keepsFilm || !std::filesystem::exists(request.film)) return false;
    std::optional<FilmReader> film;
    try {
        film.emplace(request.film);
    } catch (const UsageError& error) {
        listener.warn(fmt::format("{}; the share is taken anew", error.what()));
        return false;
    }
    std::string difference = differenceOf(header, film->header());
    if (difference.empty() && film->header().rounds() != header.rounds())
        difference =
            fmt::format("is of round {}, not of {}", film->header().rounds(), header.rounds());
    else if (difference.empty() && !holdTheSame(header, film->header()))
        difference = "is of other shares";
    if (!difference.empty())
        throw UsageError(fmt::format("{} {}; --resume keeps films of this share only", request.film,
                                     difference));
    listener.info(fmt::format("{} is there already", request.film));
    return true;
}

/// Takes the samples of a share and writes them.
class ShareRender {
  public:
    ShareRender(Renderer& renderer, const ResolvedPicture& picture, const RenderRequest& request,
                const SessionEvents& events, const Listener& listener)
        : renderer_(renderer), picture_(picture), request_(request), events_(events),
          listener_(listener) {}

    ShareResult take(const PlannedShare& share, const std::string& file);

  private:
    bool show(const Backend& backend, uint64_t more);
    bool takeBand(const PlannedShare& share, const PictureArea& band, uint32_t firstPixel,
                  FilmWriter& writer);

    Renderer& renderer_;
    const ResolvedPicture& picture_;
    const RenderRequest& request_;
    const SessionEvents& events_;
    const Listener& listener_;
    uint64_t samples_ = 0, done_ = 0; ///< of all bands
    ShareResult result_;
};

/// So many more samples are done. False: no more are wanted.
bool ShareRender::show(const Backend& backend, uint64_t more) {
    done_ += more;
    RenderProgress state;
    state.samplesAtMost = samples_ * picture_.settings.estimator.branches; // in paths
    state.samplesDone = done_ * picture_.settings.estimator.branches;
    state.counters = backend.counters();
    state.share = double(done_) / double(samples_);
    return !events_.progress || events_.progress(state) != Next::Cancel;
}

/// False if it was cancelled.
bool ShareRender::takeBand(const PlannedShare& share, const PictureArea& band, uint32_t firstPixel,
                           FilmWriter& writer) {
    const FilmHeader& header = share.header;
    const bool isPlanned = !header.planned.empty();
    const auto pixels = inBand(share.pixels, firstPixel, band.pixelCount());
    if (isPlanned && pixels.empty()) {
        writer.add(std::vector<SharedPixel>(band.pixelCount()));
        return true;
    }
    RenderSettings settings = picture_.settings;
    settings.area = band;
    const Stopwatch preparing;
    const std::shared_ptr<Backend> backend = renderer_.backend(settings, false);
    result_.render.prepareSeconds += preparing.seconds();
    listener_.doing(Stage::Sampling, "taking samples");
    const Stopwatch rendering;
    SharedBand taken(*backend, band, [&](uint64_t more) { return show(*backend, more); });
    if (header.hasAlpha()) taken.countCovered([&] { return renderer_.viewer(); });
    const bool isWhole = isPlanned ? taken.takePlanned(pixels, firstPixel, header.rounds())
                                   : taken.takeBlocks(header);
    result_.render.renderSeconds += rendering.seconds();
    const RenderCounters counters = backend->counters();
    result_.render.counters.paths += counters.paths;
    result_.render.counters.rays += counters.rays;
    if (!isWhole) return false;
    const Film film = taken.film();
    count(film, settings, result_.render);
    const std::vector<float> layers =
        header.holdsLayers
            ? layersByPixel(*renderer_.viewer(), film, renderer_.scene(), picture_.camera, request_)
            : std::vector<float>{};
    const Stopwatch writing;
    writer.add(taken.sums(), layers);
    result_.writeSeconds += writing.seconds();
    return true;
}

ShareResult ShareRender::take(const PlannedShare& share, const std::string& file) {
    const FilmHeader& header = share.header;
    RenderResult& render = result_.render;
    FilmWriter writer(file, header);
    samples_ = header.samplesHeld();
    render.samplesAtMost = samples_ * picture_.settings.estimator.branches;
    std::vector<PictureArea> bands = bandsOf(picture_.settings.area, renderer_.mostPixels());
    renderer_.requireMemory(bands.front().pixelCount());
    if (header.isEmpty()) bands.clear();
    uint32_t firstPixel = 0; // of the band
    for (const PictureArea& band : bands) {
        render.cancelled = !takeBand(share, band, firstPixel, writer);
        if (render.cancelled) return result_;
        firstPixel += uint32_t(band.pixelCount());
    }
    if (!header.planned.empty()) render.pixelsUnreached = 0; // others have samples of them
    render.bands = bands.size();
    listener_.doing(Stage::Writing, "writing " + file);
    const Stopwatch writing;
    writer.finish();
    result_.writeSeconds += writing.seconds();
    return result_;
}

} // namespace

std::string fingerprintOf(const Scene& scene, const Camera& camera) {
    return fmt::format("{:08x}-{}", sceneIdentity(scene, camera), renderingCode());
}

void requireFingerprint(const std::string& expected, const Scene& scene, const Camera& camera,
                        const std::string& source) {
    const std::string here = fingerprintOf(scene, camera);
    if (expected == here) return;
    const auto refuse = [&](const std::string& what) {
        throw SceneError(fmt::format("{}: {}: its fingerprint is {} here, and {} was expected",
                                     source, what, here, expected));
    };
    if (expected.size() != here.size()) refuse("--expect names no fingerprint");
    if (expected.substr(0, 8) != here.substr(0, 8))
        refuse("the scene or its camera is not the one that was submitted");
    refuse(fmt::format("this build of the program, {}, takes other samples than the one that "
                       "submitted it",
                       version()));
}

FilmHeader headerOfPicture(const Scene& scene, const ResolvedPicture& picture,
                           const RenderRequest& request, const FilmOrigin& origin,
                           const std::string& backend, const std::string& device) {
    if (request.background)
        throw UsageError("shares have no --background: films have no place for it");
    // Films count the samples that a surface covers; those of such filters have weights.
    if (request.transparent && hasNegativeLobes(picture.settings.estimator.filter))
        throw UsageError(fmt::format("shares have no --transparent with the pixel filter {}, which "
                                     "is negative in places: --filter box has it",
                                     nameOf(picture.settings.estimator.filter)));
    FilmHeader film;
    film.identity = {version(), renderingCode(), scene.file, sceneIdentity(scene, picture.camera),
                     backend,   device};
    film.settings = picture.settings;
    film.scene = origin.scene;
    film.command = origin.command;
    film.layers = request.layers;
    for (const PictureNote& note : legendOf(request.layers, scene))
        film.legend.push_back({note.name, printable(note.text)});
    return film;
}

ShareResult takeShare(Renderer& renderer, std::shared_ptr<const Scene> scene,
                      const ResolvedPicture& picture, const RenderRequest& request,
                      const ShareRequest& share, const SessionEvents& events,
                      const Listener& listener) {
    renderer.begin(scene, picture, request.channels().size());
    const RenderIdentity identity = renderer.identity();
    const PlannedShare toTake = shareToTake(
        headerOfPicture(*scene, picture, request, share.origin, identity.backend, identity.device),
        share, listener);
    ShareResult result;
    if (isThereAlready(toTake.header, share, listener))
        result.wasThere = true;
    else
        result = ShareRender(renderer, picture, request, events, listener).take(toTake, share.film);
    result.render.backend = renderer.name();
    result.render.buildSeconds = renderer.buildSeconds();
    renderer.requireNoValidationMessages();
    return result;
}

} // namespace stromboli
