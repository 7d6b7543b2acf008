#pragma once

#include "host/core/system.hpp"
#include "host/engine/render_session.hpp"
#include "host/view/exchange.hpp"
#include "host/view/picture_source.hpp"
#include "host/view/reference_picture.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace stromboli::view {

/// When the next frame is to be made: soon after a picture has begun and ever later, as long as
/// frames take at most a thirty-third of the time, so that watching costs at most 3 %.
class Cadence {
  public:
    static constexpr double kShareOfTime = 1.0 / 33;
    static constexpr double kSoonest = 0.1, kLatest = 1; ///< seconds from one frame to the next

    void beginPicture() { *this = {}; }
    /// Seconds since the picture has begun.
    bool isDue(double seconds) const;
    /// A frame was made at this moment, and making it took so long.
    void made(double seconds, double cost);

  private:
    std::optional<double> last_;
    double cost_ = 0;
};

/// What a page is told beside the picture itself.
struct ShownState {
    std::string scene;
    uint64_t epoch = 0;  ///< numbers the pictures that were begun
    bool coarse = false; ///< in place of a picture of full size
    uint32_t fullWidth = 0, fullHeight = 0;
    bool paused = false; ///< nothing is taken until a page says so, whatever `state` is
    std::string state;   ///< "rendering", "paused", "done", "loading"
    std::string problem; ///< why what was asked for last is not there; may be empty
    double share = 0;    ///< of the work that is done
    double raysPerSecond = 0;
    bool readOnly = false;
    std::optional<Pose> pose; ///< empty: the view of a camera of the file
    // What can be steered beside it, where it is there:
    std::optional<double> turn;
    std::optional<SunPlace> sun;
    std::string variant;
    std::optional<double> seconds;
};

/// Makes frames of what a session renders, between its passes, for those who wait for them.
class Showing {
  public:
    /// Both outlive it.
    Showing(RenderSession& session, Exchange& exchange)
        : session_(session), exchange_(exchange), source_(session) {}

    /// Frames of radiance tell how it differs from this picture.
    void compareWith(std::shared_ptr<const ReferencePicture> reference) {
        reference_ = std::move(reference);
    }
    void beginPicture();
    /// Whether a pass is to be paused, because a frame is due that somebody waits for.
    bool isDue() const { return exchange_.isAwaited() && cadence_.isDue(watch_.seconds()); }
    /// Makes all frames that are awaited, whether they are due or not. isLast: and the one of the
    /// picture, for whoever comes later. isUnwanted: of what takes long; what is given up for it
    /// is missing.
    void show(const ShownState& state, bool isLast = false,
              const std::function<bool()>& isUnwanted = {});
    PictureSource& source() { return source_; }
    double secondsOfPicture() const { return watch_.seconds(); }

  private:
    std::string textOf(Shown what, const ShownState& state, const Raster& raster, int exponent);

    RenderSession& session_;
    Exchange& exchange_;
    PictureSource source_;
    std::shared_ptr<const ReferencePicture> reference_;
    Cadence cadence_;
    Stopwatch watch_;
    uint64_t number_ = 0; ///< of the last frame
};

/// The upright perspective view that is nearest to a camera's. `scene` says where the middle is
/// that it is at a distance from.
Pose poseOf(const Camera& camera, const Scene& scene);

} // namespace stromboli::view
