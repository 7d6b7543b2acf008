#include "host/view/live_view.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <tuple>
#include <utility>

namespace stromboli::view {
namespace {

/// The first picture after a move is to take at most so many seconds, denoised if that is shown.
constexpr double kSlowCoarse = 0.25;
constexpr uint32_t kFinest = 2, kCoarsest = 16;
/// One of full size that shows nothing for longer has finer ones before it.
constexpr double kLongWait = 0.7;
/// Samples of a pixel of a coarse picture: as few as tell how noisy they are.
constexpr uint32_t kCoarseSamples = 2;
/// After so many seconds without news a view that is said to move is taken to rest.
constexpr double kRest = 0.4;
constexpr double kLook = 0.1; ///< seconds between two looks at what else there is to do

void requireSize(const compare::Picture& reference, const Crop& picture) {
    if (reference.width == picture.width && reference.height == picture.height) return;
    throw UsageError(fmt::format("the reference has {} x {} pixels, and the picture {} x {}: give "
                                 "-r and --crop of the reference, or neither",
                                 reference.width, reference.height, picture.width, picture.height));
}

} // namespace

LiveView::LiveView(RenderSession& session, Exchange& exchange, LiveRequest request)
    : session_(session), exchange_(exchange), request_(std::move(request)),
      showing_(session, exchange), scene_(request_.scene.scene), loading_(request_.load),
      asked_(request_.source) {
    session_.begin(scene_, request_.picture);
    const RenderSettings& settings = session_.picture().settings;
    full_ = {settings.area.width, settings.area.height};
    // All pictures have the kernel of the first: size and branches are settled.
    request_.picture.size = full_;
    request_.picture.crop = settings.area.crop;
    request_.picture.branches = settings.estimator.branches;
    // Coarse pictures have other pixels, and what is sharp is looked for once.
    const Camera& camera = session_.picture().camera;
    if (camera.lensRadius > 0) request_.picture.camera.focus = camera.focusDistance;
    if (request_.reference) {
        requireSize(request_.reference->picture, settings.area.rendered());
        showing_.compareWith(request_.reference);
    }
    beginFirst();
}

RenderRequest LiveView::requestNow() const {
    RenderRequest request = request_.picture;
    if (fileCamera_) {
        request.camera = CameraRequest(CameraChoice::File);
        request.camera.place = fileCamera_;
    }
    if (pose_) {
        request.camera = CameraRequest();
        request.camera.from = pose_->from;
        request.camera.at = pose_->at;
        request.camera.fieldOfView = pose_->fieldOfView * glm::pi<double>() / 180;
        request.camera.aperture = pose_->aperture;
        if (pose_->aperture > 0) request.camera.focus = pose_->focus; // a pinhole has none
    }
    return request;
}

// --- Pictures ------------------------------------------------------------------------------------

void LiveView::beginFirst() {
    ++epoch_;
    isFirst_ = true;
    beginCoarse(coarseness_);
}

void LiveView::beginCoarse(uint32_t coarseness) {
    RenderRequest request = requestNow();
    const auto fewer = [&](uint32_t pixels) { return std::max(pixels / coarseness, 1u); };
    request.size = PictureSize{fewer(full_.width), fewer(full_.height)};
    if (request.crop.width > 0) {
        Crop& crop = request.crop;
        crop = {crop.x / coarseness, crop.y / coarseness, fewer(crop.width), fewer(crop.height)};
    }
    request.budget = {};
    request.budget.mostPathsPerPixel = kCoarseSamples * request_.picture.branches.value_or(1);
    session_.begin(scene_, request);
    isCoarse_ = true;
    isOver_ = false;
    level_ = coarseness;
    isMeasured_ = false;
    share_ = 0;
    showing_.beginPicture();
}

void LiveView::beginFull() {
    session_.begin(scene_, requestNow());
    isCoarse_ = false;
    isOver_ = false;
    samplesDone_ = 0;
    showing_.beginPicture();
}

// --- What is asked for ---------------------------------------------------------------------------

void LiveView::steer(const Steering& steering) {
    if (steering.paused) isPaused_ = *steering.paused;
    if (steering.moving) isMoving_ = *steering.moving;
    sinceSteering_ = {};
    isStale_ = true;
    reload(steering);
    EnvironmentRequest around = request_.source.environment;
    if (steering.turn && !around.sun) around.rotationDegrees = *steering.turn;
    if (steering.sun && around.sun) {
        around.sun->azimuth = steering.sun->azimuth;
        around.sun->elevation = steering.sun->elevation;
    }
    const auto before = std::pair(pose_, fileCamera_);
    const bool isRelit = relight(around), isElsewhere = look(steering);
    if (!isRelit && !isElsewhere) return;
    try {
        beginFirst();
    } catch (const SceneError&) { // no camera can be there: the view stays where it was
        std::tie(pose_, fileCamera_) = before;
        beginFirst();
    }
}

bool LiveView::look(const Steering& steering) {
    if (steering.fileCamera && *steering.fileCamera >= scene_->cameras.size()) return false;
    if (!steering.pose && !steering.fileCamera) return false;
    pose_ = steering.pose;
    fileCamera_ = steering.fileCamera;
    return true;
}

/// A turn leaves the environment's tables as they are; so does the azimuth of a sun.
bool LiveView::relight(const EnvironmentRequest& wanted) {
    EnvironmentRequest& now = request_.source.environment;
    if (!scene_->environment || scene_->environment->isConstant()) return false;
    SceneChange change;
    change.rotation = rotationOf(wanted, request_.scene.rotationOfFile);
    if (wanted.sun && wanted.sun->elevation != now.sun->elevation) {
        auto sky = std::make_shared<Environment>(environmentOf(*wanted.sun));
        sky->strength = scene_->environment->strength;
        change.environment = std::move(sky);
    }
    now = asked_.environment = wanted;
    if (!change.environment && *change.rotation == scene_->environment->rotation) return false;
    session_.change(change);
    scene_ = session_.sharedScene();
    return true;
}

/// Another set of materials or another moment is read from the file.
void LiveView::reload(const Steering& steering) {
    FileSelection wanted = asked_.reading.selection;
    const std::vector<std::string>& names = scene_->variants;
    if (steering.variant && *steering.variant < int(names.size()))
        wanted.variant = *steering.variant < 0 ? "" : names[size_t(*steering.variant)];
    if (steering.seconds && scene_->animationSeconds > 0) {
        wanted.seconds = steering.seconds;
        if (*steering.seconds < 0) wanted.seconds.reset();
    }
    FileSelection& asked = asked_.reading.selection;
    if (wanted.variant == asked.variant && wanted.seconds == asked.seconds) return;
    asked = wanted;
    problem_.clear();
    loading_.ask(asked_);
}

void LiveView::takeLoaded() {
    std::optional<SceneLoading::Loaded> loaded = loading_.take();
    if (!loaded) return;
    isStale_ = true;
    if (!loaded->scene.scene) {
        problem_ = loaded->problem;
        asked_.reading.selection = request_.source.reading.selection;
        return;
    }
    if (fileCamera_ && *fileCamera_ >= loaded->scene.scene->cameras.size()) fileCamera_.reset();
    try {
        session_.begin(loaded->scene.scene, requestNow());
    } catch (const SceneError& error) { // no camera can be there
        problem_ = error.what();
        asked_.reading.selection = request_.source.reading.selection;
        return beginFirst();
    }
    const EnvironmentRequest around = request_.source.environment;
    request_.scene = std::move(loaded->scene);
    request_.source = std::move(loaded->request);
    scene_ = request_.scene.scene;
    relight(around); // may have been steered meanwhile
    beginFirst();
}

/// The first picture after a move is finished whatever happens, so that there is always one to be
/// seen; what follows is left as soon as somebody wants something else.
void LiveView::pass(const std::function<bool()>& wantsToEnd) {
    const auto rays = [this] { return session_.result().counters.rays; };
    const uint64_t raysBefore = rays();
    SessionEvents events;
    uint64_t raysNow = raysBefore;
    events.progress = [&](const RenderProgress& progress) {
        share_ = progress.share;
        raysNow = progress.counters.rays;
        if (wantsToEnd()) return Next::Cancel;
        if (isFirst_) return Next::GoOn;
        // Before each pixel has a sample, the coarse picture is the better one.
        samplesDone_ =
            progress.samplesDone / session_.picture().settings.estimator.branches; // of paths
        const bool isFit = samplesDone_ >= session_.picture().settings.area.pixelCount();
        const bool isWanted = exchange_.isSteered() || exchange_.isAsked() || loading_.isReady() ||
                              (!isCoarse_ && isFit && showing_.isDue());
        return isWanted ? Next::Pause : Next::GoOn;
    };
    isOver_ = !session_.pass(events);
    if (isOver_) share_ = 1;
    isStale_ = true;
    const double seconds = showing_.secondsOfPicture();
    raysPerSecond_ = seconds > 0 ? double(std::max(raysNow, rays())) / seconds : 0;
}

/// The first picture after the next move takes about as long as this one would, in as many pixels,
/// to be pleasant: until it is shown, which took `shown` seconds.
void LiveView::chooseCoarseness(double shown) {
    isMeasured_ = true;
    if (!isFirst_) return;
    // Before the very first one the denoiser's kernels were compiled.
    double seconds = epoch_ == 1 ? coarseSeconds_ : coarseSeconds_ + shown;
    for (; seconds > kSlowCoarse && coarseness_ < kCoarsest; seconds /= 4)
        coarseness_ *= 2;
    for (; seconds * 4 < 0.8 * kSlowCoarse && coarseness_ > kFinest; seconds *= 4)
        coarseness_ /= 2;
}

void LiveView::refine() {
    isFirst_ = false;
    const double secondsOfOneSample = coarseSeconds_ * level_ * level_ / kCoarseSamples;
    if (level_ > kFinest && secondsOfOneSample > kLongWait)
        beginCoarse(level_ / 2);
    else
        beginFull();
}

// --- The loop ------------------------------------------------------------------------------------

void LiveView::attend() {
    const bool rests = isOver_ || isPaused_;
    const bool isFit = rests || samplesDone_ >= session_.picture().settings.area.pixelCount();
    if ((isStale_ && exchange_.isAwaited() && isFit && (rests || showing_.isDue())) ||
        (rests && exchange_.lacksAFrame())) {
        const Stopwatch watch;
        // A coarse picture is always shown; one of full size may take longer than a move can wait.
        showing_.show(state(), false, [this] {
            return !isCoarse_ && (exchange_.isSteered() || loading_.isReady());
        });
        isStale_ = false;
        // Once: it waits for somebody to look, and then may stay for long.
        if (isCoarse_ && !isMeasured_) chooseCoarseness(watch.seconds());
    }
    exchange_.answer(*this);
}

void LiveView::run(const std::function<bool()>& wantsToEnd) {
    while (!wantsToEnd()) {
        if (loading_.isReady()) takeLoaded();
        if (exchange_.isSteered()) steer(exchange_.takeSteering());
        if (!isOver_ && (isCoarse_ || !isPaused_)) {
            pass(wantsToEnd);
            if (wantsToEnd()) break;
            // Before the very first one a kernel was compiled.
            if (isOver_ && isCoarse_)
                coarseSeconds_ =
                    epoch_ == 1 ? session_.result().renderSeconds : showing_.secondsOfPicture();
        }
        if (isCoarse_ && !isOver_) { // what there is of it is not worth showing yet
            exchange_.answer(*this);
            continue;
        }
        attend();
        if (isCoarse_) {
            if (exchange_.isSteered()) continue;
            if (isPaused_) { // the coarse picture is what there is to be seen
                exchange_.waitForWork(kLook);
                continue;
            }
            if (isMoving_ && sinceSteering_.seconds() < kRest) {
                exchange_.waitForWork(kLook / 10);
                continue;
            }
            isMoving_ = false;
            refine();
        } else if (isOver_ || isPaused_) {
            exchange_.waitForWork(kLook);
        }
    }
    exchange_.close();
}

ShownState LiveView::state() const {
    ShownState s;
    s.scene = request_.name;
    s.epoch = epoch_;
    s.coarse = isCoarse_;
    const Crop& crop = request_.picture.crop;
    s.fullWidth = crop.width > 0 ? crop.width : full_.width;
    s.fullHeight = crop.width > 0 ? crop.height : full_.height;
    s.paused = isPaused_;
    s.state = loading_.isUnderWay()   ? "loading"
              : isPaused_             ? "paused"
              : isOver_ && !isCoarse_ ? "done"
                                      : "rendering";
    s.problem = problem_;
    const SceneRequest& source = asked_;
    const bool isPicture = scene_->environment && !scene_->environment->isConstant();
    if (source.environment.sun)
        s.sun = {source.environment.sun->azimuth, source.environment.sun->elevation};
    else if (isPicture)
        s.turn = source.environment.rotationDegrees;
    s.variant = source.reading.selection.variant;
    s.seconds = source.reading.selection.seconds;
    s.share = isCoarse_ ? 0 : share_;
    s.raysPerSecond = raysPerSecond_;
    s.pose = pose_;
    return s;
}

// --- Answers -------------------------------------------------------------------------------------

std::string LiveView::commandNow(const ToneWords& tone, bool denoised) const {
    static_cast<void>(toneOf(tone)); // throws
    ResolvedPicture picture = session_.picture();
    picture.settings.area = {full_.width, full_.height, request_.picture.crop};
    return request_.command({pose_, fileCamera_, request_.source, picture, tone, denoised});
}

Reply LiveView::probe(uint32_t x, uint32_t y) {
    return {200, "application/json", showing_.source().probe(x, y), ""};
}

Reply LiveView::command(const ToneWords& tone, bool denoised) {
    return {200, "text/plain", commandNow(tone, denoised), ""};
}

Reply LiveView::save(const SaveRequest& request) {
    if (isCoarse_) throw UsageError("the picture of full size has not begun yet");
    const bool isPng = request.format == SaveRequest::Format::Png;
    PictureNotes notes;
    if (request_.notes)
        notes = request_.notes(session_.result(), commandNow(request.tone, request.denoised));
    return {200, isPng ? "image/png" : "image/x-exr", showing_.source().file(request, notes),
            isPng ? "view.png" : "view.exr"};
}

} // namespace stromboli::view
