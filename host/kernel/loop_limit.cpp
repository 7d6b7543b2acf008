#include "host/kernel/loop_limit.hpp"

#include "shaders/shared/interface.h"

#include <algorithm>

namespace stromboli {

uint32_t loopLimit(const vulkan::Device& device, uint32_t passes) {
    constexpr uint32_t kLlvmpipePasses = 65535, kGuard = 1u << 20;
    return device.description().isCpu() ? std::max(kLlvmpipePasses / passes, 2u) : kGuard;
}

uint32_t passesOfCameraRays(std::span<const uint32_t> constants) {
    // sampleBlackmanHarris() of shaders/include/pixel_filter.glsl, for columns and rows.
    constexpr uint32_t kInversion = 2 * (10 + 1);
    const bool inverts = constants[SPEC_PIXEL_FILTER] == gpu::FILTER_BLACKMAN_HARRIS;
    const uint32_t legs = std::max(constants[SPEC_TRAVERSAL_LEGS], 1u);
    const uint32_t steps = constants[SPEC_TRAVERSAL_STEPS] + 1;
    return (legs > 1 ? legs * (steps + 1) : steps) + (inverts ? kInversion : 0);
}

} // namespace stromboli
