// The pictures of a shadow catcher, which a session takes before those of the objects.
#include "host/engine/render_session.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace stromboli {
namespace {

/// As many samples for every pixel as the picture has on the mean; of a picture that goes on until
/// it is good enough, or until its time is up, so many.
constexpr uint32_t kSamplesOfOpenPictures = 256;
PathBudget evenly(const PathBudget& budget) {
    const uint32_t paths = budget.pathsPerPixel();
    PathBudget result;
    result.mostPathsPerPixel = paths == kMostSamples || budget.stop.open()
                                   ? std::min(paths, kSamplesOfOpenPictures)
                                   : paths;
    return result;
}

} // namespace

/// The radiance of the catcher in that scene, pixel by pixel of the band, and what it covers.
Film RenderSession::takeCaught(Scene scene, const SessionEvents& events,
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
    looks.keepsNoisy = false;
    looks.budget = evenly(request_.budget);
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
    if (!catching_) catching_ = std::make_unique<RenderSession>(device_);
    catching_->begin(std::make_shared<const Scene>(std::move(scene)), looks);
    const RenderResult result = catching_->run(asking);
    result_.renderSeconds += result.renderSeconds;
    result_.buildSeconds += result.buildSeconds;
    result_.prepareSeconds += result.prepareSeconds;
    result_.counters.paths += result.counters.paths;
    result_.counters.rays += result.counters.rays;
    if (result.cancelled) result_.cancelled = true;
    if (result.lost) result_.lost = result.lost;
    return caught;
}

void RenderSession::catchLight(const SessionEvents& events) {
    listener_.doing(Stage::Sampling, "taking samples of the shadow catcher");
    const std::string& catcher = *request_.shadowCatcher;
    std::vector<float> coverage, again;
    const auto isOff = [this] { return result_.cancelled || result_.lost; };
    Film amongObjects, glow;
    const Film alone = takeCaught(catcherAlone(*scene_, catcher), events, coverage);
    if (!isOff()) amongObjects = takeCaught(catcherAmongObjects(*scene_, catcher), events, again);
    if (!isOff() && objectsGlow(*scene_))
        glow = takeCaught(catcherInGlow(*scene_, catcher), events, again);
    if (isOff()) { // nothing is caught
        const auto pixels = size_t(bands_[band_].pixelCount());
        caught_ = CaughtLight{std::vector(pixels, glm::vec3(0)), std::vector(pixels, 1.0f)};
        return;
    }
    caught_ = caughtLight(amongObjects, alone, glow, coverage);
    listener_.doing(Stage::Sampling, "taking samples");
}

} // namespace stromboli
