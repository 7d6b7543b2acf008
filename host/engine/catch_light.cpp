// The pictures of a shadow catcher, which a session takes before those of the objects.
#include "host/engine/render_session.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace stromboli {
namespace {

/// Samples of pictures that go on until they are good enough, in place of those that they may have.
constexpr uint32_t kSamplesOfOpenPictures = 256;
/// By which it is measured how long a sample takes, where time is limited.
constexpr uint32_t kSamplesToMeasure = 4;
/// The part of the time that the catcher's pictures may take, all together.
constexpr double kShareOfTime = 0.25;

PathBudget evenly(uint32_t paths) {
    PathBudget budget;
    budget.mostPathsPerPixel = paths;
    return budget;
}

/// For every pixel as many as the picture has on the mean.
uint32_t samplesOf(const PathBudget& budget) {
    const uint32_t paths = budget.pathsPerPixel();
    return paths == kMostSamples || budget.stop.open() ? std::min(paths, kSamplesOfOpenPictures)
                                                       : paths;
}

} // namespace

/// The radiance of the catcher in that scene, pixel by pixel of the band, and what it covers.
Film RenderSession::takeCaught(Scene scene, uint32_t samples, const SessionEvents& events,
                               std::vector<float>& coverage) {
    const PictureArea& area = bands_[band_];
    RenderRequest looks = request_;
    looks.shadowCatcher.reset();
    looks.background.reset();
    looks.transparent = true;
    looks.layers.clear();
    looks.size = {area.width, area.height};
    looks.crop = area.rendered();
    looks.resolvedCamera = picture_.camera;
    looks.branches = 1; // the same in both scenes
    looks.guiding = Guiding::Off;
    looks.portals = PortalUse::Off;
    looks.estimator.gapProposal = false; // whose width goes by the geometry
    looks.keepsNoisy = false;
    looks.budget = evenly(samples);
    Film caught;
    caught.area = area;
    coverage.clear();
    SessionEvents asking;
    asking.progress = [&](const RenderProgress&) {
        const Next next = events.progress ? events.progress(lastTold_) : Next::GoOn;
        return cancelAsked_ || next == Next::Cancel ? Next::Cancel : Next::GoOn;
    };
    asking.bandDone = [&](const FinishedBand& band) {
        caught.pixels.insert(caught.pixels.end(), band.film.pixels.begin(), band.film.pixels.end());
        const std::vector<float>& alpha = band.beside.channels.at(kAlphaChannel);
        coverage.insert(coverage.end(), alpha.begin(), alpha.end());
    };
    if (!catching_) {
        Listener warnings;
        warnings.message = [listener = listener_](Severity severity, const std::string& text) {
            if (severity >= Severity::Warning) listener.warn(text);
        };
        catching_ = std::make_unique<RenderSession>(device_, warnings);
    }
    catching_->begin(std::make_shared<const Scene>(std::move(scene)), looks);
    const RenderResult result = catching_->run(asking);
    result_.renderSeconds += result.renderSeconds;
    result_.buildSeconds += result.buildSeconds;
    result_.prepareSeconds += result.prepareSeconds;
    result_.counters.paths += result.counters.paths;
    result_.counters.rays += result.counters.rays;
    result_.samplesRejected += result.samplesRejected;
    if (result.cancelled) result_.cancelled = true;
    if (result.lost) result_.lost = result.lost;
    return caught;
}

void RenderSession::catchLight(const SessionEvents& events) {
    listener_.doing(Stage::Sampling, "taking samples of the shadow catcher");
    const std::string& catcher = *request_.shadowCatcher;
    std::vector<float> coverage, again;
    const auto isOff = [this] { return result_.cancelled || result_.lost; };
    const bool glows = objectsGlow(*scene_);
    uint32_t samples = samplesOf(request_.budget);
    Film alone, amongObjects, glow;
    const auto takeAlone = [&] {
        alone = takeCaught(catcherAlone(*scene_, catcher), samples, events, coverage);
    };
    if (const double seconds = request_.budget.stop.seconds; seconds > 0) {
        const uint32_t most = samples;
        samples = std::min(most, kSamplesToMeasure);
        const double before = result_.renderSeconds;
        takeAlone();
        const double ofAll = (glows ? 3 : 2) * (result_.renderSeconds - before) / samples;
        samples = uint32_t(std::clamp(kShareOfTime * seconds / ofAll, 1.0, double(most)));
    }
    if (!isOff()) takeAlone();
    if (!isOff())
        amongObjects = takeCaught(catcherAmongObjects(*scene_, catcher), samples, events, again);
    if (!isOff() && glows)
        glow = takeCaught(catcherInGlow(*scene_, catcher), samples, events, again);
    catching_.reset(); // its scene and film
    if (isOff()) {     // nothing is caught
        const auto pixels = size_t(bands_[band_].pixelCount());
        caught_ = CaughtLight{std::vector(pixels, glm::vec3(0)), std::vector(pixels, 1.0f)};
        return;
    }
    caught_ = caughtLight(amongObjects, alone, glow, coverage);
    listener_.doing(Stage::Sampling, "taking samples");
}

} // namespace stromboli
