#pragma once

#include "host/bench/alternate.hpp"
#include "host/bench/report.hpp"
#include "host/vulkan/device.hpp"

namespace stromboli::bench {

/// To the device's memory and back, as renders do it (through a staging buffer where that memory
/// is not the host's).
TransferReport benchTransfer(const vulkan::Device& device, const AlternatePlan& plan);

} // namespace stromboli::bench
