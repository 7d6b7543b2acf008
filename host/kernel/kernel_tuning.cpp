#include "host/kernel/kernel_tuning.hpp"

#include "host/vulkan/buffer.hpp"
#include "shaders/shared/interface.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace stromboli {
namespace {

/// So that a dispatch takes some 0.1 s although each group ends well before the driver's limit of
/// loop passes (hardLimit): 32 groups of 1800 iterations of 1.2 us (a Zen 3 core).
constexpr uint32_t kGroupsPerThread = 32;

/// Paths that the wavefront scheduler has under way: enough to fill a large GPU some times over,
/// and some 130 MB of memory.
constexpr uint32_t kWavefrontPaths = 1u << 18;

/// Texel buffers of the path kernel: the scene's, the work list, the film and the table of the
/// pixel filter; other kernels have fewer.
constexpr size_t kTexelBuffers = SCENE_BINDING_COUNT + 3;

/// A CPU device (lavapipe) runs a subgroup as one SIMD register per thread. A subgroup per
/// workgroup, so that none waits for another's lanes; all other pixels come to these lanes
/// through the work list. Storage texel buffers where they are large enough (prefersTexels),
/// because storage buffer loads are a scalar loop over the lanes there, 20 times slower. Up to 16
/// entries a traversal stack in registers, of which each costs two selections a step and some
/// spilling, is cheaper than one in memory, also a loop over the lanes.
DeviceTuning forCpu(uint32_t subgroupSize) {
    DeviceTuning t;
    t.workgroupSize = subgroupSize;
    t.traversalSteps = 5;
    t.richTraversalSteps = 8;
    // Of sixteen lanes one comes to a placement, or leaves one, in nearly every step.
    t.placedTraversalSteps = 1;
    t.traversalLegs = 20;
    t.registerStack = 16;
    t.driverThreads = std::max(std::thread::hardware_concurrency(), 1u);
    t.lanes = t.workgroupSize * kGroupsPerThread * t.driverThreads;
    return t;
}

/// A GPU needs a lane per pixel, up to a million, to hide the latency of its memory; storage
/// buffers, because texel buffers are limited in size (2^27 texels is common, 2^16 allowed). Its
/// lanes index their own memory in one instruction.
DeviceTuning forGpu() {
    return {};
}

} // namespace

bool prefersTexels(const vulkan::DeviceDescription& device, uint64_t rowBytes) {
    const std::vector<vulkan::BufferUse> texels(kTexelBuffers, vulkan::BufferUse::Texel);
    return device.isCpu() && vulkan::areBindable(device, texels) &&
           rowBytes <= bindingLimit(device, vulkan::BufferUse::Texel).bytes;
}

DeviceTuning resolve(const KernelTuning& tuning, const vulkan::Device& device, uint64_t rowBytes) {
    DeviceTuning t =
        device.description().isCpu() ? forCpu(device.description().subgroupSize) : forGpu();
    t.texelFetch = tuning.texelFetch.value_or(prefersTexels(device.description(), rowBytes));
    t.workgroupSize = tuning.workgroupSize.value_or(t.workgroupSize);
    t.traversalSteps = tuning.traversalSteps.value_or(t.traversalSteps);
    t.richTraversalSteps = tuning.traversalSteps.value_or(t.richTraversalSteps);
    t.placedTraversalSteps = tuning.traversalSteps.value_or(t.placedTraversalSteps);
    t.traversalLegs = tuning.traversalLegs.value_or(t.traversalLegs);
    t.registerStack = tuning.registerStack.value_or(t.registerStack);
    t.scheduler = tuning.scheduler.value_or(t.scheduler);
    if (t.scheduler == PathScheduler::Wavefront) t.lanes = kWavefrontPaths;
    t.lanes = tuning.lanes.value_or(t.lanes);
    t.driverThreads = tuning.driverThreads.value_or(t.driverThreads);
    t.itemsPerDispatch = tuning.itemsPerDispatch.value_or(t.itemsPerDispatch);
    t.countSteps = tuning.countSteps;
    t.everythingOn = tuning.everythingOn;
    return t;
}

} // namespace stromboli
