#include "host/kernel/kernel_tuning.hpp"

#include "host/vulkan/buffer.hpp"
#include "shaders/shared/interface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <thread>
#include <vector>

namespace stromboli {

// --- Tuning --------------------------------------------------------------------------------------

namespace {

/// So that a dispatch takes some 0.1 s although each group ends well before the driver's limit of
/// loop passes (hardLimit): 32 groups of 1800 iterations of 1.2 us (a Zen 3 core).
constexpr uint32_t kGroupsPerThread = 32;

/// Paths that the wavefront scheduler has under way: enough to fill a large GPU some times over,
/// and some 130 MB of memory.
constexpr uint32_t kWavefrontPaths = 1u << 18;

/// Texel buffers of the path kernel: the scene's, the work list, the film and the table of the
/// pixel filter; other kernels have fewer.
constexpr size_t kTexelBuffers = SCENE_BINDING_COUNT + 5;

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
    t.stepsFitRays = true;
    // In nearly every step one of sixteen lanes comes to a placement or leaves one.
    t.placedTraversalSteps = 1;
    t.traversalLegs = 20;
    t.registerStack = 16;
    t.limitsLoops = true;
    t.driverThreads = std::max(std::thread::hardware_concurrency(), 1u);
    t.lanes = t.workgroupSize * kGroupsPerThread * t.driverThreads;
    return t;
}

/// Lanes that a large GPU has under way at a time: an H200 has 132 multiprocessors of 2,048.
constexpr uint32_t kLanesOfGpu = 1u << 18;

/// The host adds strands up, and a first pass has 4 to 16 samples to deal out. Not measured.
constexpr uint32_t kMostStrands = 16;

/// A GPU needs a lane per pixel, up to a million, to hide the latency of its memory, and several
/// at a pixel where there are few; storage buffers, because texel buffers are limited in size (2^27
/// texels is common, 2^16 allowed). Steps that branch, a stack in registers and sixteen steps
/// between two services take 0.72 to 0.82 of the time on an H200 (docs/results.md, "On a GPU").
DeviceTuning forGpu() {
    DeviceTuning t;
    t.lanesToFill = kLanesOfGpu;
    t.traversalSteps = t.richTraversalSteps = 16;
    t.registerStack = 16;
    t.stepsBranch = true;
    return t;
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
    t.stepsFitRays = t.stepsFitRays && !tuning.traversalSteps;
    t.traversalLegs = tuning.traversalLegs.value_or(t.traversalLegs);
    t.registerStack = tuning.registerStack.value_or(t.registerStack);
    t.stepsBranch = tuning.stepsBranch.value_or(t.stepsBranch);
    t.scheduler = tuning.scheduler.value_or(t.scheduler);
    if (t.scheduler == PathScheduler::Wavefront) t.lanes = kWavefrontPaths;
    t.lanes = tuning.lanes.value_or(t.lanes);
    t.lanesToFill = tuning.lanesToFill.value_or(t.lanesToFill);
    t.driverThreads = tuning.driverThreads.value_or(t.driverThreads);
    t.itemsPerDispatch = tuning.itemsPerDispatch.value_or(t.itemsPerDispatch);
    t.countSteps = tuning.countSteps;
    t.everythingOn = tuning.everythingOn;
    return t;
}

// --- Limits of loops -----------------------------------------------------------------------------

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

// --- The pace of dispatches ----------------------------------------------------------------------

DispatchPace::DispatchPace(double targetSeconds, uint32_t limit)
    : target_(targetSeconds), limit_(limit), iterations_(std::min(64u, limit)) {}

void DispatchPace::took(double seconds) {
    // At most fourfold a step: a first dispatch that includes compilation, or a last one with few
    // lanes, says little about the next.
    const double factor = std::clamp(target_ / std::max(seconds, 1e-9), 0.25, 4.0); // 1 ns
    const double wanted = std::exp2(std::round(std::log2(iterations_ * factor)));
    iterations_ = uint32_t(std::clamp(wanted, std::min(16.0, double(limit_)), double(limit_)));
}

uint32_t strandsThatSuit(const DeviceTuning& tuning, uint64_t pixels) {
    const uint64_t wanted = tuning.lanesToFill / std::max<uint64_t>(pixels, 1);
    return std::clamp(std::bit_floor(uint32_t(wanted)), 1u, kMostStrands);
}

DeviceTuning forPixels(DeviceTuning tuning, uint64_t pixels) {
    const uint64_t items = pixels * tuning.strands;
    tuning.lanes = uint32_t(std::min<uint64_t>(tuning.lanes, items));
    tuning.itemsPerDispatch = uint32_t(std::min<uint64_t>(tuning.itemsPerDispatch, items));
    return tuning;
}

} // namespace stromboli
