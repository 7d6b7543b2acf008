#pragma once

#include "host/cli/job.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/team_backend.hpp"

#include <future>
#include <memory>
#include <string>
#include <vector>

namespace stromboli {

/// The devices that a render uses (--device), each with a backend that keeps the scene from one
/// picture to the next.
class RenderDevices {
  public:
    /// Begins to open them, on another thread.
    RenderDevices(const std::string& wanted, PathScheduler scheduler);

    /// Waits until they are open. Throws DeviceError.
    void open();

    /// Of their kind: names, each once.
    std::string name() const;
    /// Pixels of a picture that all of them, and so many bytes of the host's memory, have room for.
    uint64_t pixelsThatFit(const GpuScene& scene, const Estimator& estimator, uint64_t hostBytes,
                           uint64_t hostBytesPerPixel) const;

    /// Whether all of them have room for the scene's textures, as they were packed.
    bool haveRoomForTextures(const GpuScene& scene) const;

    /// The pictures to come are of this scene.
    void setScene(const GpuScene& scene);
    /// Ready for a picture of the scene that was set: of one device its own backend, of several
    /// those that share the work (TeamBackend). A device on which that fails is left out, which is
    /// said; throws DeviceError if none is left.
    std::shared_ptr<Backend> backendFor(const Camera& camera, const RenderSettings& settings);
    /// Opens all devices anew.
    void reopen();

    /// What sees surfaces of the picture: the first device that is left, or nothing.
    Viewer* viewer();

    /// Throws DeviceError if the validation layer had anything to say.
    void requireNoValidationMessages() const;

  private:
    struct Seat {
        vulkan::OpenDevice open;
        std::shared_ptr<VulkanBackend> backend; ///< of the last picture, with the scene
    };

    void sayWhich() const;
    void sayHow();
    void leaveOutWhoDroppedOut();
    void prepare(Seat& seat, const Camera& camera, const RenderSettings& settings) const;
    void prepareAll(const Camera& camera, const RenderSettings& settings);

    std::string wanted_;
    PathScheduler scheduler_;
    std::future<std::vector<vulkan::OpenDevice>> opening_;
    std::vector<Seat> seats_;
    const GpuScene* scene_ = nullptr;
    bool howIsSaid_ = false;
    std::shared_ptr<TeamBackend> team_; ///< of the last picture, if there were several
};

} // namespace stromboli
