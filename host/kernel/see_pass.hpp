#pragma once

#include "host/kernel/device_scene.hpp"
#include "host/render/estimator.hpp"
#include "host/render/layers.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "scene/camera/camera.hpp"
#include "shaders/shared/layer_types.h"
#include "shaders/shared/render_types.h"

#include <span>
#include <vector>

namespace stromboli {

/// The specialisation constants of shaders/see.comp for a picture.
std::vector<uint32_t> seeConstants(const GpuScene& scene, const Camera& camera,
                                   const Estimator& settings, const DeviceTuning& tuning,
                                   Seeing what);

/// shaders/see.comp with these constants.
vulkan::ComputePipeline makeSeePipeline(const vulkan::Device& device,
                                        const std::vector<uint32_t>& constants,
                                        const DeviceTuning& tuning);

/// Traces the camera rays of a run of pixels on the device.
class SeePass {
  public:
    /// constants: those of the pipeline; filter: the picture's table (filter_table.hpp). Device,
    /// scene, pipeline and filter must outlive the object. Throws DeviceError.
    SeePass(const vulkan::Device& device, const DeviceScene& scene,
            const vulkan::ComputePipeline& pipeline, std::span<const uint32_t> constants,
            const vulkan::Buffer& filter, const gpu::Frame& frame, const DeviceTuning& tuning,
            uint32_t pixels);

    /// Until each pixel has as many samples as it is to have. Throws DeviceError.
    void run(std::vector<gpu::SeenPixel>& pixels);

  private:
    gpu::SeeStatus dispatch(uint32_t softIterations);

    const vulkan::Device& device_;
    const vulkan::ComputePipeline& pipeline_;
    DeviceTuning tuning_;
    uint32_t pixelCount_, hardIterations_;
    vulkan::Queue queue_;
    vulkan::Buffer frame_, pixels_, status_;
    vulkan::DescriptorSet set_;
    double seconds_ = 0; ///< of the last dispatch
};

/// What the device has found, in the scene's terms.
SeenPixel seenPixelOf(const gpu::SeenPixel& pixel, const GpuScene& scene);

} // namespace stromboli
