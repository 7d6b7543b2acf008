#pragma once

#include "host/bench/embree.hpp"
#include "host/bench/report.hpp"
#include "host/vulkan/device.hpp"

namespace stromboli::bench {

/// Threads of a device that is a CPU (llvmpipe: LP_NUM_THREADS, at most one a core); of others 0.
uint32_t deviceThreads(const vulkan::DeviceDescription& device);

Circumstances circumstancesOf(const vulkan::DeviceDescription& device, const OpenedEmbree& embree,
                              uint32_t threads, const std::string& commandLine);

} // namespace stromboli::bench
