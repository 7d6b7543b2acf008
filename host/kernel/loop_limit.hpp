#pragma once

#include "host/vulkan/device.hpp"

#include <cstdint>
#include <span>

namespace stromboli {

/// Iterations that a kernel's main loop may run in one dispatch; `passes`: those of any loop that
/// one of its iterations can take. llvmpipe ends all loops of a group, silently, after 65,535
/// passes; on other devices it is only a guard against endless loops: a ray through 2^20 nodes is
/// none.
uint32_t loopLimit(const vulkan::Device& device, uint32_t passes);

/// Passes for the steps of the traversal and, where a sample begins, for the pixel filter's
/// inversion. constants: specialisation constants by their SPEC_ numbers.
uint32_t passesOfCameraRays(std::span<const uint32_t> constants);

} // namespace stromboli
