#pragma once

#include "host/checkpoint/kept_render.hpp"
#include "host/cli/job.hpp"
#include "host/cli/render_devices.hpp"
#include "host/cli/report.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace stromboli {

/// Takes the samples of a job with backends that are made for it, in bands of at most so many
/// pixels.
using TakeSamples = std::function<void(const MakeBackend&, const std::function<Viewer*()>&,
                                       uint64_t mostPixels, RenderReport&)>;

/// What takes the samples of a scene's pictures, one after the other: made once.
class Renderer {
  public:
    explicit Renderer(const Options& options);

    void render(const Job& job, const Options& options, const TakeSamples& take,
                RenderReport& report);

    /// The next pictures are of another scene.
    void changeScene() { isStale_ = true; }

  private:
    void openAndBuild(const Job& job, const Options& options, RenderReport& report);
    void renderOnDevice(const Job& job, const Options& options, const TakeSamples& take,
                        RenderReport& report);
    void renderOnReference(const Job& job, const Options& options, const TakeSamples& take,
                           RenderReport& report);

    std::unique_ptr<BuiltScene> built_;
    bool isStale_ = false;                 ///< `built_` is of an earlier scene
    KeptParts kept_;                       ///< of the moments of an animation
    std::optional<RenderDevices> devices_; ///< none: the reference renders
};

} // namespace stromboli
