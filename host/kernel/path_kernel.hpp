#pragma once

#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/vulkan/compute_pipeline.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

// --- Words of a path -----------------------------------------------------------------------------

/// 32-bit words that a scheduler keeps of a path in memory (shaders/shared/path_fields.h), in
/// kernels with these features.
uint32_t pathWords(const KernelFeatures& features, PathScheduler scheduler);

// --- The kernel ----------------------------------------------------------------------------------

/// The path kernel, compiled with the features that a picture needs.
class PathKernel {
  public:
    /// stage: of the wavefront scheduler (STAGE_, shaders/shared/wavefront_types.h); none: the
    /// kernel of the persistent scheduler.
    PathKernel(const vulkan::Device& device, const KernelFeatures& features, bool texelFetch,
               vulkan::Specialiser specialiser, std::optional<uint32_t> stage = {});

    const KernelFeatures& features() const { return features_; }
    const vulkan::ComputePipeline& pipeline() const { return pipeline_; }

  private:
    KernelFeatures features_;
    vulkan::ComputePipeline pipeline_;
};

// --- What drivers make of it ---------------------------------------------------------------------

/// What a device's driver makes of one of the kernels of a picture.
struct KernelReport {
    std::string kernel; ///< "persistent", or a stage of the wavefront scheduler
    std::vector<vulkan::PipelineStatistic> statistics;
};

/// The kernels of both schedulers, compiled as for a GPU. The device is opened for compiling
/// (vulkan::DeviceUse). Throws DeviceError.
std::vector<KernelReport> reportKernels(const vulkan::Device& device, const GpuScene& scene,
                                        const Camera& camera, const Estimator& estimator);

} // namespace stromboli
