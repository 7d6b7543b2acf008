#pragma once

#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/render/backend.hpp"
#include "host/render/settings.hpp"
#include "host/vulkan/buffer.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "shaders/shared/render_types.h"

#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// How the kernel runs; the defaults suit the device. None of it changes a picture.
struct KernelTuning {
    std::optional<bool> texelFetch; ///< read the scene through storage texel buffers
    std::optional<uint32_t> workgroupSize;
    std::optional<uint32_t> traversalSteps;
    std::optional<uint32_t> itemsPerDispatch;
    double targetSeconds = 0.1;              ///< of a dispatch
    std::optional<uint32_t> fixedIterations; ///< instead of pacing by time (tests)
};

/// Pixels of a dispatch on a GPU: enough lanes to fill any, and 64 MiB of suspended paths.
inline constexpr uint32_t kLargestDispatch = 1u << 20;

/// A buffer the kernel needs: for `stromboli info` and the check before the upload.
struct BufferSize {
    std::string name;
    uint64_t bytes = 0;
};

/// All device buffers of a scene and a picture, known before anything is allocated.
/// itemsPerDispatch: pixels that a dispatch works on at most.
std::vector<BufferSize> predictBuffers(const GpuScene& scene, const RenderSettings& settings,
                                       uint32_t itemsPerDispatch = kLargestDispatch);

/// Takes samples with the Vulkan path kernel.
class VulkanBackend final : public Backend {
  public:
    /// Throws DeviceError if a buffer is over a limit of the device (before any upload).
    VulkanBackend(const vulkan::Device& device, const GpuScene& scene, const Camera& camera,
                  const RenderSettings& settings, const KernelTuning& tuning = {});

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override;
    RenderCounters counters() const override { return counters_; }
    const KernelFeatures& features() const { return features_; }

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
    gpu::DispatchStatus dispatch(const Segment& segment, uint32_t itemCount);
    void readBack(const Segment& segment, std::span<const gpu::WorkItem> items, Film& film);
    uint32_t cropPixel(uint32_t picturePixel) const;
    uint32_t picturePixel(uint32_t cropPixel) const;

    const vulkan::Device& device_;
    RenderSettings settings_;
    gpu::Frame frame_;
    bool texelFetch_;
    DeviceTuning deviceTuning_;
    KernelFeatures features_;
    uint32_t itemsPerDispatch_;
    uint32_t hardIterations_;
    std::optional<uint32_t> fixedIterations_;
    DispatchPace pace_;
    vulkan::Queue queue_;
    std::vector<vulkan::Buffer> sceneBuffers_;
    vulkan::Buffer frameBuffer_, workItems_, suspended_, status_;
    vulkan::ComputePipeline pipeline_;
    std::vector<Segment> segments_;
    RenderCounters counters_;
};

} // namespace stromboli
