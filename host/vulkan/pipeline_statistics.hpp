#pragma once

#include "host/vulkan/device.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace stromboli::vulkan {

/// What a driver says of the machine code that it has made of a kernel.
struct PipelineStatistic {
    std::string name; ///< the driver's words, such as "VGPRs" or "Spilled VGPRs"
    double value = 0;
};

/// In the driver's order. The device is one that was opened for compiling (DeviceUse). Throws
/// DeviceError.
std::vector<PipelineStatistic> statisticsOf(const Device& device, VkPipeline pipeline);

} // namespace stromboli::vulkan
