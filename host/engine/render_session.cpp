#include "host/engine/render_session.hpp"

#include "host/core/error.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/film/shown_film.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/sampling_plan.hpp"
#include "host/render/sampling_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace stromboli {

RenderSession::RenderSession(const DeviceRequest& device, Listener listener)
    : listener_(std::move(listener)), device_(device), renderer_(device, listener_) {}

void RenderSession::begin(std::shared_ptr<const Scene> scene, const RenderRequest& request,
                          const Keeping& keeping) {
    sampling_.reset(); // refers to the renderer's last backend
    bands_.clear();
    over_ = true; // if what follows throws
    scene_ = std::move(scene);
    keeping_ = keeping;
    request_ = toGoOn(request, keeping);
    if (request_.shadowCatcher) {
        requireCatcher(*scene_, *request_.shadowCatcher); // resolvePicture() comes too late
        hideCatcher(*request_.shadowCatcher);
        request_.transparent = !request_.background;
    }
    denoise::requireUsable(request_.denoiser);
    picture_ = resolvePicture(*scene_, request_, listener_);
    if (changing_ && changing_->scene() == scene_) keepCamera();
    cancelAsked_ = false;
    bandIsOver_ = false;
    isAlone_ = keeping_.begun.has_value();
    secondsBefore_ = 0;
    pixelsDone_ = 0;
    noises_.clear();
    guide_.reset();
    covered_.clear();
    caught_.reset();
    lastTold_ = {};
    denoised_.reset();
    result_ = {};
    result_.samplesAtMost = mostPathsOf(picture_.settings);
    over_ = false;
}

/// Pictures of one scene share what is built of it.
void RenderSession::hideCatcher(const std::string& catcher) {
    if (hidden_.catcher != catcher || (scene_ != hidden_.from && scene_ != hidden_.objects))
        hidden_ = {catcher, scene_,
                   std::make_shared<const Scene>(withoutCatcher(*scene_, catcher))};
    scene_ = hidden_.objects;
}

/// Objects that move take no camera with them: it is where it is in the scene as it was read, in
/// the medium that is there now.
void RenderSession::keepCamera() {
    const PictureArea& area = picture_.settings.area;
    picture_.camera = makeCamera(changing_->original(), request_.camera, area.width, area.height,
                                 request_.framing);
    if (!scene_->movingInstances.empty())
        picture_.camera.medium = mediumAt(*scene_, picture_.camera.position);
}

void RenderSession::moveCamera(const CameraRequest& camera) {
    if (!scene_) throw std::logic_error("no picture has been begun");
    RenderRequest request = request_;
    request.camera = camera;
    begin(scene_, request);
}

void RenderSession::change(const SceneChange& change) {
    if (!scene_) throw std::logic_error("no picture has been begun");
    if (request_.shadowCatcher)
        throw UsageError("a scene with a shadow catcher cannot be changed: begin another picture");
    if (!changing_ || changing_->scene() != scene_) changing_.emplace(scene_);
    changing_->apply(change);
    sampling_.reset(); // refers to the renderer's last backend
    over_ = true;      // if what follows throws
    renderer_.sceneHasChanged(scene_, changing_->scene(), change);
    begin(changing_->scene(), RenderRequest(request_));
}

void RenderSession::prepare() {
    renderer_.begin(scene_, picture_, request_.channels().size());
    result_.backend = renderer_.name();
    result_.buildSeconds = renderer_.buildSeconds();
    bands_ = bandsToRender(picture_.settings.area, renderer_.mostPixels(), keeping_, listener_);
    renderer_.requireMemory(bands_.front().pixelCount());
    result_.bands = bands_.size();
    band_ = 0;
    if (denoises() && bands_.size() > 1)
        throw UsageError("--denoise looks at the picture as a whole, and its film does not fit the "
                         "memory here: give it more --film-memory");
}

/// The time that is left is shared by rows with the bands to come.
RenderSettings RenderSession::settingsOfBand() const {
    RenderSettings settings = picture_.settings;
    const uint64_t left = settings.area.pixelCount() - pixelsDone_;
    settings.area = bands_[band_];
    const uint64_t pixels = settings.area.pixelCount();
    double& seconds = settings.budget.stop.seconds;
    const double used = secondsBefore_ + result_.renderSeconds;
    if (seconds > 0 && used > 0)
        seconds = std::max((seconds - used) * double(pixels) / double(left), 1e-3); // it begins
    else if (seconds > 0)
        seconds *= double(pixels) / double(left);
    return settings;
}

/// The backend adds up blocks where the settings ask for it.
std::shared_ptr<Backend> RenderSession::makeBackend(const RenderSettings& settings, bool again) {
    std::shared_ptr<Backend> backend = renderer_.backend(settings, again);
    if (!settings.budget.isInBlocks()) return backend;
    return std::make_shared<BlockBackend>(std::move(backend), settings.area,
                                          settings.budget.samplesPerBlock);
}

void RenderSession::beginBand() {
    const auto identity = [this] { return renderer_.identity(); };
    KeptRender render = keptRender(settingsOfBand(), keepingOfBand(keeping_, band_, bands_.size()),
                                   identity, renderer_.name(), listener_);
    render.identity = [this, identity] { // asked for when the first checkpoint is written
        if (!isAlone_) forgetEarlier(keeping_.file, bands_.size());
        isAlone_ = true;
        return identity();
    };
    if (render.begun) secondsBefore_ += render.begun->secondsUsed;
    sampling_.emplace(
        std::move(render),
        [this](const RenderSettings& settings, bool again) { return makeBackend(settings, again); },
        [listener = listener_](const std::string& line) { listener.warn(line); });
    listener_.doing(Stage::Sampling, "taking samples");
}

Next RenderSession::tell(const SessionEvents& events, RenderProgress state) {
    const uint64_t all = picture_.settings.area.pixelCount();
    // In paths, as RenderResult has them.
    state.samplesAtMost = mostPathsOf(picture_.settings);
    state.samplesDone =
        state.samplesDone * picture_.settings.estimator.branches + result_.samplesTaken;
    state.counters.paths += result_.counters.paths;
    state.counters.rays += result_.counters.rays;
    state.share =
        (double(pixelsDone_) + state.share * double(bands_[band_].pixelCount())) / double(all);
    lastTold_ = state;
    const Next next = events.progress ? events.progress(state) : Next::GoOn;
    return cancelAsked_ ? Next::Cancel : next;
}

bool RenderSession::pass(const SessionEvents& events) {
    if (over_) return false;
    try {
        return takePass(events);
    } catch (...) { // what is half made is not looked at
        over_ = true;
        sampling_.reset();
        throw;
    }
}

bool RenderSession::takePass(const SessionEvents& events) {
    if (bandIsOver_) {
        sampling_.reset();
        covered_.clear();
        caught_.reset();
        ++band_;
        bandIsOver_ = false;
    }
    if (bands_.empty()) prepare();
    if (request_.shadowCatcher && !caught_) catchLight(events);
    if (!sampling_) beginBand();
    Next next = Next::GoOn;
    if (isDenoisedEnough()) sampling_->finish();
    const bool hasMore = sampling_->pass([&](const RenderProgress& state) {
        if (next != Next::Cancel) next = tell(events, state);
        return next == Next::GoOn;
    });
    if (next == Next::Cancel) result_.cancelled = true;
    if (hasMore && !result_.cancelled) return true;
    endBand(events);
    return !over_;
}

void RenderSession::endBand(const SessionEvents& events) {
    const KeptOutcome& kept = sampling_->end();
    result_.prepareSeconds += kept.prepareSeconds;
    result_.renderSeconds += kept.renderSeconds;
    result_.counters.paths += kept.counters.paths;
    result_.counters.rays += kept.counters.rays;
    result_.lost = kept.lost;
    if (kept.fileIsThere) result_.checkpoint = sampling_->render().file.string();
    const uint64_t unreachedBefore = result_.pixelsUnreached;
    count(sampling_->film(), sampling_->render().settings, result_);
    noises_.push_back({kept.outcome.noise, bands_[band_].pixelCount()});
    if (denoises()) {
        endDenoised(events);
    } else if (events.bandDone) {
        const FloatImage seen = beside(sampling_->film());
        if (result_.pixelsUnreached == unreachedBefore && !request_.background &&
            !request_.shadowCatcher)
            events.bandDone({sampling_->film(), kept.outcome.noise, seen});
        else
            events.bandDone({shownFilm(), kept.outcome.noise, seen});
    }
    pixelsDone_ += bands_[band_].pixelCount();
    if (result_.cancelled || result_.lost)
        leaveOutTheRest(events);
    else if (band_ + 1 < bands_.size())
        bandIsOver_ = true; // its film can be looked at until the next pass
    else
        over_ = true;
    if (over_) renderer_.requireNoValidationMessages();
}

void RenderSession::leaveOutTheRest(const SessionEvents& events) {
    for (size_t i = band_ + 1; i < bands_.size(); ++i) {
        if (events.bandLeftOut) events.bandLeftOut(bands_[i]);
        noises_.push_back({{}, bands_[i].pixelCount()});
        result_.pixelsUnreached += bands_[i].pixelCount();
    }
    over_ = true;
}

RenderResult RenderSession::run(const SessionEvents& events) {
    while (pass(events)) {
    }
    return result();
}

RenderResult RenderSession::result() const {
    RenderResult result = result_;
    std::vector<PartNoise> noises = noises_;
    if (sampling_ && !over_ && !bandIsOver_)
        noises.push_back({sampling_->outcome().noise, film().pixels.size()});
    result.noise = togetherOf(noises);
    return result;
}

const Film& RenderSession::film() const {
    if (!sampling_) throw std::logic_error("no sample of the picture has been taken");
    return sampling_->film();
}

/// Kept until there are more samples: pixels without any show a neighbour's.
const std::vector<float>& RenderSession::covered() {
    const uint64_t samples = sampling_->samplesDone();
    if (!covered_.empty() && coveredAt_ == samples) return covered_;
    RenderRequest looks = request_;
    looks.transparent = true;
    looks.denoiser = Denoiser::Off;
    looks.layers.clear();
    coveredAt_ = samples;
    return covered_ = std::move(see(film(), looks).channel(kAlphaChannel));
}

void RenderSession::putBackgroundBehind(Film& shown) {
    if (caught_) putUnder(shown, covered(), *caught_);
    if (!request_.background) return;
    std::vector<float> alpha = covered();
    if (caught_) addShadow(alpha, *caught_);
    putBehind(shown, alpha, *request_.background);
}

Film RenderSession::shownFilm() {
    Film shown = film();
    showNeighbours(shown, NoisePlan::kCoarsest);
    putBackgroundBehind(shown);
    return shown;
}

FloatImage RenderSession::beside(const Film& film) {
    FloatImage seen = see(film, request_);
    if (caught_ && request_.transparent) addShadow(seen.channel(kAlphaChannel), *caught_);
    return seen;
}

/// A device that is lost sees nothing.
FloatImage RenderSession::see(const Film& film, const RenderRequest& request,
                              const std::function<bool()>& isUnwanted) {
    if (request.channels().empty()) return {};
    listener_.doing(Stage::Looking, "tracing alpha and layers");
    FloatImage seen = seenChannels(result_.lost ? nullptr : renderer_.viewer(), film, *scene_,
                                   picture_.camera, request, isUnwanted);
    listener_.doing(Stage::Sampling, "taking samples");
    return seen;
}

/// The denoiser looks at layers, whether the request asks for them or not; they do not depend on
/// the samples.
const RenderSession::Denoised*
RenderSession::denoisedNowUnless(const std::function<bool()>& isUnwanted) {
    const uint64_t samples = sampling_->samplesDone();
    if (denoised_ && denoised_->samples == samples) return &*denoised_;
    if (!guide_) {
        RenderRequest looks = request_;
        looks.transparent = false;
        looks.denoiser = Denoiser::Off;
        looks.layers = {Layer::Albedo, Layer::Normal, Layer::Depth};
        FloatImage guide = see(film(), looks, isUnwanted);
        if (isUnwanted && isUnwanted()) return nullptr;
        guide_ = std::move(guide);
    }
    listener_.doing(Stage::Looking, "denoising");
    Denoised d{samples, denoise::noisyPictureOf(film(), sampling_->squaredErrors(), *guide_), {}};
    const Denoiser which = request_.denoiser == Denoiser::Off ? Denoiser::On : request_.denoiser;
    d.picture = denoise::denoisePicture(d.noisy, which, renderer_.device(), isUnwanted);
    listener_.doing(Stage::Sampling, "taking samples");
    if (d.picture.mean.empty()) return nullptr;
    return &denoised_.emplace(std::move(d));
}

/// Asked between passes alone, and before one begins, so that a render that was stopped there ends
/// with the bytes of one that was not.
bool RenderSession::isDenoisedEnough() {
    const double asked = picture_.settings.budget.stop.noise;
    if (asked == 0 || !denoises() || !sampling_->isBetweenPasses() || sampling_->samplesDone() == 0)
        return false;
    const PictureNoise& noise = denoisedNow().picture.summary.noise;
    return noise.known() && noise.most <= asked;
}

void RenderSession::endDenoised(const SessionEvents& events) {
    const Denoised& d = denoisedNow();
    result_.denoised = d.picture.summary;
    if (!events.bandDone) return;
    Film shown = film();
    for (size_t i = 0; i < shown.pixels.size(); ++i)
        shown.pixels[i].mean = d.picture.mean[i];
    putBackgroundBehind(shown);
    FloatImage seen = beside(film());
    if (request_.keepsNoisy) denoise::addChannels(seen, d.noisy, d.picture);
    events.bandDone({shown, d.picture.summary.noise, seen});
}

FloatImage RenderSession::pixels(bool statistics) {
    const Film shown = shownFilm();
    FloatImage image = linearPicture(shown, statistics);
    for (auto& [name, values] : beside(film()).channels)
        image.channels[name] = std::move(values);
    return image;
}

ByteImage RenderSession::shown(const ToneCurve& tone) {
    std::vector<float> alpha;
    if (request_.transparent) alpha = std::move(beside(film()).channel(kAlphaChannel));
    return toneMap(shownFilm(), tone, alpha);
}

FloatImage RenderSession::layers(const std::vector<Layer>& wanted) {
    RenderRequest looks = request_;
    looks.transparent = false;
    looks.denoiser = Denoiser::Off;
    looks.layers = wanted;
    return see(film(), looks);
}

const denoise::DenoisedPicture& RenderSession::denoised() {
    static_cast<void>(film()); // throws where there is none
    if (result_.lost) throw DeviceError(*result_.lost);
    return denoisedNow().picture;
}

const denoise::DenoisedPicture*
RenderSession::denoisedUnless(const std::function<bool()>& isUnwanted) {
    static_cast<void>(film()); // throws where there is none
    if (result_.lost) throw DeviceError(*result_.lost);
    const Denoised* const now = denoisedNowUnless(isUnwanted);
    return now ? &now->picture : nullptr;
}

Checkpoint RenderSession::save() const {
    if (bands_.size() > 1)
        throw UsageError("a picture in several bands is kept in the files of its checkpoint");
    if (!sampling_) throw std::logic_error("no sample of the picture has been taken");
    return {renderer_.identity(), sampling_->save()};
}

void RenderSession::forgetBands() const {
    if (bands_.size() > 1) forgetEarlier(keeping_.file, bands_.size());
}

} // namespace stromboli
