#pragma once

#include "host/engine/load_scene.hpp"
#include "host/engine/render_session.hpp"
#include "host/view/exchange.hpp"
#include "host/view/scene_loading.hpp"
#include "host/view/showing.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace stromboli::view {

/// What is viewed: from the pose or, without one, from a camera of the file (its place) or, without
/// either, from where it was begun.
struct Viewed {
    std::optional<Pose> pose;
    std::optional<size_t> fileCamera;
    const SceneRequest& scene;
    ResolvedPicture picture;
    ToneWords tone;
    bool denoised = false;
};
/// The command line that makes a picture of it.
using CommandWriter = std::function<std::string(const Viewed&)>;

struct LiveRequest {
    LoadedScene scene;
    SceneRequest source;                               ///< that it was loaded by
    SceneLoader load;                                  ///< for others of the same file
    std::string name;                                  ///< of the scene, for the page
    RenderRequest picture;                             ///< the one to begin with
    std::shared_ptr<const ReferencePicture> reference; ///< null: none
    CommandWriter command;
    /// What saved files say of how they were made; may be empty.
    std::function<PictureNotes(const RenderResult& result, const std::string& command)> notes;
};

/// Renders what pages steer to, on the thread that calls it: after each move a coarse picture, of
/// fewer pixels; at rest finer ones, as long as the one of full size would take long to begin to
/// show, and that one, with as many samples as are asked for.
class LiveView final : public Answers {
  public:
    /// The session and the exchange outlive it. Throws what resolvePicture() does, and UsageError
    /// if the reference has another size than the picture.
    LiveView(RenderSession& session, Exchange& exchange, LiveRequest request);

    /// Until wantsToEnd() says so, which is asked several times a second. Throws DeviceError.
    void run(const std::function<bool()>& wantsToEnd);

    Reply probe(uint32_t x, uint32_t y) override;
    Reply save(const SaveRequest& request) override;
    Reply command(const ToneWords& tone, bool denoised) override;

  private:
    void steer(const Steering& steering);
    bool look(const Steering& steering);
    bool relight(const EnvironmentRequest& wanted);
    void reload(const Steering& steering);
    void takeLoaded();
    void beginFirst();
    void beginCoarse(uint32_t coarseness);
    void beginFull();
    void refine();
    void pass(const std::function<bool()>& wantsToEnd);
    void chooseCoarseness(double shown);
    void attend();
    ShownState state() const;
    RenderRequest requestNow() const;
    std::string commandNow(const ToneWords& tone, bool denoised) const;

    RenderSession& session_;
    Exchange& exchange_;
    LiveRequest request_;
    PictureSize full_;
    Showing showing_;
    std::shared_ptr<const Scene> scene_; ///< what the request's has become
    SceneLoading loading_;
    SceneRequest asked_; ///< that is shown once it is loaded
    std::string problem_;
    std::optional<Pose> pose_;
    std::optional<size_t> fileCamera_;
    bool isCoarse_ = false, isOver_ = false, isPaused_ = false, isMoving_ = false;
    bool isStale_ = true; ///< what has changed since the last frame
    bool isFirst_ = true; ///< the picture is the first one after a move
    // Pixels of full size on a side of a coarse one:
    uint32_t coarseness_ = 4;  ///< of the first picture after a move
    uint32_t level_ = 4;       ///< of the coarse one that was begun last
    double coarseSeconds_ = 0; ///< that it took
    bool isMeasured_ = false;  ///< it has been shown, and the next one's coarseness chosen
    Stopwatch sinceSteering_;
    uint64_t epoch_ = 0;
    uint64_t samplesDone_ = 0; ///< of the picture of full size
    double share_ = 0, raysPerSecond_ = 0;
};

} // namespace stromboli::view
