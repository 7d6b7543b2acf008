#pragma once

#include "host/kernel/kernel_features.hpp"
#include "host/vulkan/compute_pipeline.hpp"

#include <string>
#include <vector>

namespace stromboli {

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
