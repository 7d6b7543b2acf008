#pragma once

#include "host/denoise/denoiser.hpp"
#include "host/engine/keeping.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_request.hpp"
#include "host/engine/render_result.hpp"
#include "host/engine/renderer.hpp"
#include "host/engine/scene_change.hpp"
#include "host/engine/shadow_catcher.hpp"
#include "host/film/film.hpp"
#include "host/film/image_file.hpp"

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// What whoever is told how far a picture is wants next.
enum class Next {
    GoOn,
    Pause, ///< RenderSession::pass() returns, so that the picture can be looked at
    Cancel ///< the picture ends as it is
};

/// A band of the picture, all of it in most cases, whose samples are taken.
struct FinishedBand {
    /// Pixels without samples show a neighbour that has some; denoised if the request asks for it.
    const Film& film;
    const PictureNoise& noise;
    const FloatImage& beside; ///< the channels that the request asks for beside the radiance
};

/// What a session tells while it takes samples, on the thread that called it. Functions may be
/// empty.
struct SessionEvents {
    /// Several times a second: of the picture as a whole.
    std::function<Next(const RenderProgress&)> progress;
    std::function<void(const FinishedBand&)> bandDone;
    /// Where a picture was cancelled or its device was lost: each band that was not begun.
    std::function<void(const PictureArea&)> bandLeftOut;
};

/// Pictures of scenes, one after the other, in passes between which they can be looked at, changed,
/// saved and cancelled. What a picture has in common with the one before is kept: the devices, a
/// scene that is built and uploaded, kernels that are compiled. A picture has the bytes that it has
/// in a session of its own, however often it is paused, saved and gone on with (unless its time is
/// limited).
///
///     RenderSession session;
///     session.begin(loadScene({"room.xml"}).scene, request);
///     while (session.pass())
///         show(session.shown(tone));
///     session.moveCamera(other); // the next picture
///     session.changeMaterials({{7, redder}}); // and another one
///
/// A session is used by one thread at a time, cancel() by any. There may be several sessions in a
/// process, at the same time too: they share nothing but scenes.
class RenderSession {
  public:
    /// Begins to open the devices, on another thread.
    explicit RenderSession(const DeviceRequest& device = {}, Listener listener = {});

    /// Begins a picture, in place of the one before. Nothing is built before the first pass.
    /// `keeping` says where its state is kept and what it goes on from. Throws SceneError and
    /// UsageError (resolvePicture()).
    void begin(std::shared_ptr<const Scene> scene, const RenderRequest& request,
               const Keeping& keeping = {});
    /// Begins the picture again with another camera.
    void moveCamera(const CameraRequest& camera);
    /// Begins the picture again in a scene that has become another one: numbers of materials,
    /// lights, places of objects, what is around it. The scene that was handed over stays as it is.
    /// A change of materials and lights uploads their rows and builds nothing, but where a texture
    /// begins or ceases to count; what the first motion of an object leaves where it is gets a tree
    /// of its own, which later ones keep. A kernel is compiled only where materials and lights want
    /// another one. Throws std::invalid_argument (ChangingScene::apply()).
    void change(const SceneChange& change);

    /// The picture that was begun, with nothing left open.
    const ResolvedPicture& picture() const { return picture_; }
    const RenderRequest& request() const { return request_; }
    /// The scene of that picture.
    const Scene& scene() const { return *scene_; }
    /// To begin another picture of it.
    const std::shared_ptr<const Scene>& sharedScene() const { return scene_; }

    /// Takes samples until a pass is done or progress() asks to pause; the next call goes on.
    /// False: the picture is finished, cancelled, or its device is lost for good (result()). Throws
    /// DeviceError, OutputError (checkpoints), SceneError, UsageError (`keeping`).
    bool pass(const SessionEvents& events = {});
    /// Passes until there is no more to do.
    RenderResult run(const SessionEvents& events = {});
    /// Any thread may call this: the picture ends within a fraction of a second of sampling; what
    /// comes before (building the scene, compiling) is finished first. The next one is not
    /// affected.
    void cancel() { cancelAsked_ = true; }

    bool isOver() const { return over_; }
    /// What was done so far.
    RenderResult result() const;

    // The picture so far, of the last band that was begun; not during pass().

    /// Means, variances and numbers of samples.
    const Film& film() const;
    /// That film as it is shown: pixels without samples show a neighbour, and what the request
    /// wants behind the objects is there.
    Film shownFilm();
    /// Puts the light of the request's shadow catcher and its background, if it has them, behind
    /// means of the film's pixels that may be other ones by now.
    void putBackgroundBehind(Film& shown);
    /// In floats, linear: R, G, B, the channels that the request asks for, and with `statistics`
    /// the number of samples and the variance of the mean. Pixels without samples show a neighbour.
    FloatImage pixels(bool statistics = false);
    /// The picture as it is shown on a screen, through this tone curve.
    ByteImage shown(const ToneCurve& tone);
    /// The channels of these layers, of what the picture's camera sees: whether the request asks
    /// for them or not. Traced anew at each call; all 0 where the device is lost.
    FloatImage layers(const std::vector<Layer>& wanted);
    /// The picture without its noise, by the denoiser of the request or, where it asks for none, by
    /// the program's own. Kept until there are more samples. Throws std::logic_error before the
    /// first sample, DeviceError where the device is lost.
    const denoise::DenoisedPicture& denoised();
    /// As denoised(), for whoever may find out meanwhile that it is not wanted: asked several times
    /// a second, and null where that says so.
    const denoise::DenoisedPicture* denoisedUnless(const std::function<bool()>& isUnwanted);

    /// All that another session needs to go on: Keeping::begun. Throws UsageError of a picture in
    /// several bands, whose states are in their files.
    Checkpoint save() const;
    /// Removes the checkpoints of the bands of a picture that is finished and written.
    void forgetBands() const;

  private:
    void keepCamera();
    void hideCatcher(const std::string& catcher);
    void prepare();
    void beginBand();
    bool takePass(const SessionEvents& events);
    void endBand(const SessionEvents& events);
    void leaveOutTheRest(const SessionEvents& events);
    std::shared_ptr<Backend> makeBackend(const RenderSettings& settings, bool again);
    RenderSettings settingsOfBand() const;
    Next tell(const SessionEvents& events, RenderProgress state);
    /// The picture so far without its noise.
    struct Denoised {
        uint64_t samples = 0; ///< that the picture had
        denoise::NoisyPicture noisy;
        denoise::DenoisedPicture picture;
    };
    FloatImage beside(const Film& film);
    FloatImage see(const Film& film, const RenderRequest& request,
                   const std::function<bool()>& isUnwanted = {});
    const std::vector<float>& covered();
    void catchLight(const SessionEvents& events);
    Film takeCaught(Scene scene, uint32_t samples, const SessionEvents& events,
                    std::vector<float>& coverage);
    bool denoises() const { return request_.denoiser != Denoiser::Off && !result_.lost; }
    const Denoised& denoisedNow() { return *denoisedNowUnless({}); }
    const Denoised* denoisedNowUnless(const std::function<bool()>& isUnwanted);
    bool isDenoisedEnough();
    void endDenoised(const SessionEvents& events);

    /// The last scene with a shadow catcher, and what became of it.
    struct HiddenCatcher {
        std::string catcher;
        std::shared_ptr<const Scene> from, objects;
    };

    Listener listener_;
    DeviceRequest device_;
    Renderer renderer_;
    std::unique_ptr<RenderSession> catching_; ///< takes the pictures of the shadow catcher
    std::atomic<bool> cancelAsked_ = false;
    // What belongs to the picture:
    std::shared_ptr<const Scene> scene_;
    HiddenCatcher hidden_;
    std::optional<ChangingScene> changing_; ///< has the same, if it has been changed
    RenderRequest request_;
    Keeping keeping_;
    ResolvedPicture picture_;
    std::vector<PictureArea> bands_; ///< none: not prepared yet
    size_t band_ = 0;                ///< under way, or the last one
    std::optional<KeptSession> sampling_;
    bool isAlone_ = false; ///< no checkpoint of an earlier render is in the way
    bool over_ = true;
    bool bandIsOver_ = false;  ///< the next pass begins the next band
    double secondsBefore_ = 0; ///< of the bands that were done in earlier runs
    uint64_t pixelsDone_ = 0;  ///< of the bands before
    std::vector<PartNoise> noises_;
    std::optional<FloatImage> guide_;   ///< layers that the denoiser looks at
    std::vector<float> covered_;        ///< alpha of the band's objects, where something is behind
    uint64_t coveredAt_ = 0;            ///< of so many samples
    std::optional<CaughtLight> caught_; ///< of the band, where the request has a shadow catcher
    RenderProgress lastTold_;
    std::optional<Denoised> denoised_;
    RenderResult result_;
};

} // namespace stromboli
