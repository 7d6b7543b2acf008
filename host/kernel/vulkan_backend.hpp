#pragma once

#include "host/film/film.hpp"
#include "host/kernel/dispatcher.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/render/backend.hpp"
#include "host/render/estimator.hpp"
#include "host/render/layers.hpp"
#include "host/render/recorded_path.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "shaders/shared/guide_types.h"
#include "shaders/shared/render_types.h"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- The frame -----------------------------------------------------------------------------------

/// The uniform data of a picture.
gpu::Frame makeFrame(const GpuScene& scene, const Camera& camera, const PictureArea& area,
                     const Estimator& estimator);

/// How the kernel runs for pictures of this area. strands: of a pixel; 0: those that suit the
/// device.
DeviceTuning tuningFor(const KernelTuning& tuning, const vulkan::Device& device,
                       const GpuScene& scene, const PictureArea& area, uint32_t strands = 1);

// --- The backend ---------------------------------------------------------------------------------

/// Takes samples with the Vulkan path kernel: a scene on the device, and one picture of it after
/// the other.
class VulkanBackend final : public Backend, public Viewer, public PathRecorder {
  public:
    /// The device and the scene must outlive the object. Throws DeviceError if a buffer is over a
    /// limit of the device (before any upload).
    VulkanBackend(const vulkan::Device& device, const GpuScene& scene, const Camera& camera,
                  const RenderSettings& settings, const KernelTuning& tuning = {});

    /// Begins another picture of the scene, with an empty film; what was sampled so far is
    /// forgotten, and counters start anew. The scene stays where it is, and kernels that were
    /// compiled for the same features are used again. Throws DeviceError as the constructor, and
    /// std::invalid_argument if the scene was packed for another way to find direct light
    /// (directSampling()).
    void setPicture(const Camera& camera, const RenderSettings& settings);

    /// The pictures to come are of another scene, which must outlive the object from now on; that
    /// until now is still there. The next call is setPicture(). Kernels that were compiled for the
    /// same features are used again, and so are buffers in which both scenes have the same bytes.
    void setScene(const GpuScene& scene);
    /// The scene has become another one in these bindings (repackMaterials()), and is uploaded
    /// there. The next call is setPicture().
    void sceneHasChanged(std::span<const uint32_t> bindings);

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override;
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override;
    /// As many as 2^16 in one dispatch.
    std::vector<SampleValue> samplesAlone(uint32_t pixel, uint32_t first, uint32_t count) override;
    RecordedPath record(uint32_t pixel, uint32_t sample) override;
    RenderCounters counters() const override { return dispatcher_->counters(); }
    void beginAt(uint32_t firstSample) override;
    /// Strands of a pixel of the picture.
    uint32_t strands() const { return film_->strands(); }
    KeptPixels save(const Film& film, PixelRun run) override;
    void restore(PixelRun run, const KeptPixels& pixels, Film& film) override;

    std::vector<SeenPixel> see(uint32_t first, std::span<const uint32_t> samples, Seeing what,
                               uint32_t firstSample = 0) override;

    const KernelFeatures& features() const { return kernel_->features(); }
    /// Only with KernelTuning::countSteps.
    StepCounters steps() const { return dispatcher_->steps(); }
    /// Seconds by the device's clock in all dispatches so far.
    double kernelSeconds() const { return dispatcher_->kernelSeconds(); }

  private:
    /// Those of the scheduler; of the persistent one the first alone.
    StageKernels kernelsFor(const KernelFeatures& features, const DeviceTuning& tuning);
    const PathKernel& kernelFor(const KernelFeatures& features, const DeviceTuning& tuning,
                                std::optional<uint32_t> stage);
    std::unique_ptr<Dispatcher> makeDispatcher(std::span<const FilmSegment> film,
                                               const StageKernels& kernels, const gpu::Frame& frame,
                                               const DeviceTuning& tuning) const;
    std::vector<SampleValue> someAlone(uint32_t pixel, uint32_t first, uint32_t count) const;
    std::unique_ptr<vulkan::Buffer> uploaded(std::string_view name, const std::vector<Row>& rows,
                                             const DeviceTuning& tuning) const;

    const vulkan::Device& device_;
    const GpuScene* scene_;
    KernelTuning tuning_;
    std::unique_ptr<DeviceScene> deviceScene_;
    SceneBuffers filled_; ///< of the scene to come
    std::map<std::pair<KernelFeatures, std::optional<uint32_t>>, PathKernel>
        kernels_;                     ///< and stage
    bool kernelsFetchTexels_ = false; ///< all of them
    // What belongs to one picture:
    Camera camera_;
    Estimator estimator_;
    PictureArea area_;
    gpu::Frame frame_{};
    const PathKernel* kernel_ = nullptr; ///< one of kernels_
    std::unique_ptr<DeviceFilm> film_;
    /// What guides samples, and behind it the shadow map; none: kernels read neither, and are given
    /// another buffer.
    std::unique_ptr<vulkan::Buffer> guide_;
    std::unique_ptr<vulkan::Buffer> filter_; ///< the table of its pixel filter
    std::unique_ptr<Dispatcher> dispatcher_; ///< refers to film, filter, guide and kernels
};

} // namespace stromboli
