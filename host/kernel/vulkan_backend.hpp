#pragma once

#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/backend.hpp"
#include "host/render/settings.hpp"
#include "host/vulkan/buffer.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "shaders/shared/render_types.h"

#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// How well traversal filled the lanes.
struct StepCounters {
    uint64_t busy = 0; ///< traversal steps of lanes that had a ray under way ...
    uint64_t all = 0;  ///< ... out of these
};

/// Takes samples with the Vulkan path kernel.
class VulkanBackend final : public Backend {
  public:
    /// Throws DeviceError if a buffer is over a limit of the device (before any upload).
    VulkanBackend(const vulkan::Device& device, const GpuScene& scene, const Camera& camera,
                  const RenderSettings& settings, const KernelTuning& tuning = {});

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override;
    /// The pixel is in the crop.
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override;
    RenderCounters counters() const override { return counters_; }
    const KernelFeatures& features() const { return features_; }
    /// Only with KernelTuning::countSteps.
    StepCounters steps() const { return steps_; }
    /// Seconds by the device's clock in all dispatches so far.
    double kernelSeconds() const { return kernelSeconds_; }

  private:
    /// A run of the crop's pixels whose states fit one binding.
    struct Segment {
        uint32_t firstPixel;
        uint32_t pixelCount;
        vulkan::Buffer pixels;
        std::unique_ptr<vulkan::DescriptorSet> set;
    };
    void createSegments();
    bool runChunk(const Segment& segment, std::span<const gpu::WorkItem> items,
                  const std::function<bool(uint64_t)>& advance);
    gpu::Dispatch dispatchConstants(const Segment& segment, uint32_t itemCount,
                                    uint32_t groups) const;
    void dispatch(const Segment& segment, uint32_t itemCount, gpu::DispatchStatus& status);
    void count(const gpu::DispatchStatus& status);
    void readBack(const Segment& segment, std::span<const gpu::WorkItem> items, Film& film);
    uint32_t cropPixel(uint32_t picturePixel) const;
    uint32_t picturePixel(uint32_t cropPixel) const;

    const vulkan::Device& device_;
    RenderSettings settings_;
    gpu::Frame frame_;
    DeviceTuning tuning_;
    KernelFeatures features_;
    uint32_t hardIterations_, softIterations_;
    std::optional<uint32_t> fixedIterations_;
    DispatchPace pace_;
    vulkan::Queue queue_;
    std::vector<vulkan::Buffer> sceneBuffers_;
    vulkan::Buffer frameBuffer_, workItems_, suspended_, splits_, status_;
    vulkan::ComputePipeline pipeline_;
    std::vector<Segment> segments_;
    RenderCounters counters_;
    StepCounters steps_;
    double kernelSeconds_ = 0;
};

} // namespace stromboli
