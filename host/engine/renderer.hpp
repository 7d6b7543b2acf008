#pragma once

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_request.hpp"
#include "host/engine/scene_change.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/team_backend.hpp"
#include "host/vulkan/device.hpp"

#include <exception>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// The devices that a renderer uses, each with a backend that keeps the scene and the kernels from
/// one picture to the next.
class RenderDevices {
  public:
    /// Begins to open them on a thread of its own: nearly all of it is loading and linking the
    /// driver's libraries, which takes as long as reading a scene.
    RenderDevices(const DeviceRequest& request, Listener listener);

    /// Waits until they are open. Throws DeviceError.
    void open();
    /// Opens all devices anew.
    void reopen();

    /// The names of the devices, each once.
    std::string name() const;
    /// Pixels of a picture that all of them, and so many bytes of the host's memory, have room for.
    uint64_t pixelsThatFit(const GpuScene& scene, const Estimator& estimator, uint64_t hostBytes,
                           uint64_t bytesPerPixel) const;
    /// Bytes of the host's memory that drivers on its own processor take for the scene, and for
    /// each pixel of a picture.
    uint64_t hostBytesOfScene(const GpuScene& scene) const;
    uint64_t hostBytesPerPixel() const;
    /// Whether all of them have room for the scene's textures, as they were packed.
    bool haveRoomForTextures(const GpuScene& scene) const;

    /// The pictures to come are of this scene, which must outlive them.
    void setScene(const GpuScene& scene);
    /// That scene has become another one in these bindings.
    void sceneHasChanged(std::span<const uint32_t> bindings);
    /// Ready for a picture of the scene that was set: of one device its own backend, of several
    /// those that share the work (TeamBackend). A device on which that fails is left out, which is
    /// said; throws DeviceError if none is left.
    std::shared_ptr<Backend> backendFor(const Camera& camera, const RenderSettings& settings);
    /// What sees surfaces of the picture: the first device that is left, or nothing.
    Viewer* viewer();
    /// The first of those that are left, or nothing.
    const vulkan::Device* first() const;

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
    void prepareAll(const Camera& camera, const RenderSettings& asked);

    DeviceRequest request_;
    Listener listener_;
    std::future<std::vector<vulkan::OpenDevice>> opening_;
    std::exception_ptr whyNotOpen_; ///< what opening them has thrown
    std::vector<Seat> seats_;
    const GpuScene* scene_ = nullptr;
    bool howIsSaid_ = false;
    std::shared_ptr<TeamBackend> team_; ///< of the last picture, if there were several
};

/// What a render takes of the host's memory, in bytes: an estimate before it begins.
struct MemoryNeed {
    uint64_t soFar = 0; ///< the program, the scene as it was read, and what was built of it
    uint64_t scene = 0; ///< what the samplers make of the scene
    uint64_t film = 0;  ///< and of the picture, or of each of its bands
    uint64_t all() const { return soFar + scene + film; }
};

/// What takes the samples of pictures, one after the other: made once, with the devices or the
/// reference. It builds a scene and brings it to the devices when it is first asked for, and keeps
/// it for the pictures that follow.
class Renderer {
  public:
    Renderer(const DeviceRequest& request, Listener listener);

    /// Makes ready for a picture of the scene, which must not change while pictures of it are made.
    /// Neither a scene that is there already nor a kernel that was compiled for the same features
    /// is made again. `channels`: those of a picture beside the radiance.
    void begin(std::shared_ptr<const Scene> scene, const ResolvedPicture& picture, size_t channels);

    /// `before` has become `scene`, which may be the same object, by this change, while no picture
    /// of it was under way. Of materials, lights and the environment it brings to the devices what
    /// has become another, and builds nothing. Motions, and textures that begin or cease to count,
    /// are left to the next begin(), which keeps trees of what has not moved, and texels.
    void sceneHasChanged(const std::shared_ptr<const Scene>& before,
                         const std::shared_ptr<const Scene>& scene, const SceneChange& change);

    /// A backend for the settings, which are those of the picture or of a part of it; it is good
    /// until the next one is asked for. `again`: the device of the last one is lost, all are opened
    /// anew. Throws DeviceError.
    std::shared_ptr<Backend> backend(const RenderSettings& settings, bool again);
    /// What sees surfaces of the part that the last backend is for; nothing where all devices are
    /// lost.
    Viewer* viewer();
    /// A device for what is done to a picture afterwards; nothing where the reference renders.
    const vulkan::Device* device() const { return devices_ ? devices_->first() : nullptr; }

    /// Pixels that a part of the picture may have.
    uint64_t mostPixels() const;
    /// What the picture needs in parts of so many pixels.
    MemoryNeed memoryNeeded(uint64_t pixels) const;
    /// Says what it needs. Throws UsageError if that is more than DeviceRequest allows.
    void requireMemory(uint64_t pixels) const;
    /// The devices' names, or the reference.
    const std::string& name() const { return name_; }
    /// What a checkpoint of the picture is told by.
    RenderIdentity identity() const;
    /// Seconds that building the scene took; 0 if it was there.
    double buildSeconds() const { return buildSeconds_; }
    const Scene& scene() const { return *scene_; }
    const Camera& camera() const { return camera_; }

    /// Throws DeviceError if the validation layer had anything to say.
    void requireNoValidationMessages() const;

  private:
    void build(const Estimator& estimator);
    void fitToPicture();
    uint64_t bytesForFilms() const;
    uint64_t bytesPerPixel() const;
    uint64_t bytesOfScene() const;

    DeviceRequest request_;
    Listener listener_;
    std::shared_ptr<const Scene> scene_;
    Camera camera_;
    RenderSettings settings_;
    size_t channels_ = 0;
    std::string name_;
    double buildSeconds_ = 0;
    uint64_t resident_ = 0;             ///< of the process, when begin() was through
    bool samplersHaveIt_ = false;       ///< the scene, then
    std::unique_ptr<BuiltScene> built_; ///< of builtOf_; outlives the devices' backends
    std::shared_ptr<const Scene> builtOf_;
    LightSelection builtFor_;
    uint64_t gatheredRows_ = kUsualGatheredRows; ///< that it was built with
    /// What the scene that was built has become, to be built of what is kept of it; null: nothing.
    std::shared_ptr<const Scene> movedTo_;
    KeptParts kept_;                       ///< of moments of an animation, and where objects move
    std::optional<RenderDevices> devices_; ///< none: the reference renders
    std::shared_ptr<Backend> reference_;   ///< of the last picture
    Viewer* referenceViewer_ = nullptr;    ///< the same object
};

} // namespace stromboli
