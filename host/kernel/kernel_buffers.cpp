#include "host/kernel/kernel_buffers.hpp"

#include "host/kernel/filter_table.hpp"
#include "host/kernel/path_words.hpp"
#include "shaders/shared/render_types.h"
#include "shaders/shared/wavefront_types.h"

#include <algorithm>

namespace stromboli {

using vulkan::BufferPlan;
using vulkan::BufferUse;

namespace {

template <class T>
uint64_t sizeOf(const std::vector<T>& v) {
    return v.size() * sizeof(T);
}

} // namespace

vulkan::BufferUse rowUse(const DeviceTuning& tuning) {
    return tuning.texelFetch ? BufferUse::Texel : BufferUse::Storage;
}

std::vector<BufferPlan> planSceneBuffers(const GpuScene& scene, const DeviceTuning& tuning) {
    const BufferUse rows = rowUse(tuning);
    return {
        {"BVH buffer", sizeOf(scene.bvh.records), rows},
        {"primitive buffer", sizeOf(scene.primitives), rows},
        {"material buffer", sizeOf(scene.materials), rows},
        {"light buffer", sizeOf(scene.lights.lights), rows},
        {"light table", sizeOf(scene.lights.table), rows},
        {"environment", scene.lights.environmentRows().size_bytes(), rows},
        {"texture buffer", sizeOf(scene.details), rows, "--max-texture N makes textures smaller"}};
}

uint64_t largestSceneBuffer(const GpuScene& scene) {
    uint64_t most = 0;
    for (const BufferPlan& plan : planSceneBuffers(scene, {}))
        most = std::max(most, plan.bytes);
    return most;
}

uint64_t largestRowBuffer(const GpuScene& scene, uint64_t pixels) {
    const uint64_t items = std::min<uint64_t>(DeviceTuning{}.itemsPerDispatch, pixels);
    return std::max(largestSceneBuffer(scene), items * sizeof(gpu::WorkItem));
}

PathBuffers pathBuffers(const KernelFeatures& features, uint64_t lanes, PathScheduler scheduler) {
    const uint64_t bytes = lanes * pathWords(features, scheduler) * sizeof(uint32_t);
    if (scheduler == PathScheduler::Persistent)
        return {{"suspended paths", bytes, BufferUse::Storage}, std::nullopt};
    const uint64_t queues = gpu::QUEUE_COUNT * (sizeof(gpu::QueueHead) + lanes * sizeof(uint32_t));
    return {{"states of paths", bytes, BufferUse::Storage},
            BufferPlan{"queues of paths", queues, BufferUse::Storage}};
}

std::vector<BufferPlan> planBuffers(const GpuScene& scene, const PictureArea& area,
                                    const Estimator& estimator, const DeviceTuning& tuning) {
    const uint64_t pixels = area.pixelCount();
    const uint64_t items = std::min<uint64_t>(tuning.itemsPerDispatch, pixels);
    const uint64_t lanes = std::min<uint64_t>(tuning.lanes, pixels);
    const BufferUse rows = rowUse(tuning);
    std::vector<BufferPlan> plans = planSceneBuffers(scene, tuning);
    plans.push_back({"film", pixels * sizeof(gpu::PixelState), rows});
    plans.push_back({"work list", items * sizeof(gpu::WorkItem), rows});
    // What a path has does not depend on the camera.
    const PathBuffers paths =
        pathBuffers(kernelFeatures(scene, Camera{}, estimator, tuning), lanes, tuning.scheduler);
    plans.push_back(paths.paths);
    if (paths.queues) plans.push_back(*paths.queues);
    plans.push_back({"pixel filter", filterRows(estimator.filter) * sizeof(Row), rows});
    plans.push_back({"frame constants", sizeof(gpu::Frame), BufferUse::Uniform});
    plans.push_back({"dispatch status", sizeof(gpu::DispatchStatus), BufferUse::Storage});
    return plans;
}

uint64_t pixelsPerSegment(const vulkan::DeviceDescription& device, const DeviceTuning& tuning) {
    constexpr uint64_t kMostPixels = uint64_t(1) << 24; // 1 GiB
    const uint64_t bytes =
        std::min(bindingLimit(device, rowUse(tuning)).bytes, device.largestAllocation);
    return std::min(bytes / sizeof(gpu::PixelState), kMostPixels);
}

uint64_t filmPixelsThatFit(const vulkan::DeviceDescription& device, const GpuScene& scene,
                           const Estimator& estimator) {
    // A picture of many pixels has the largest of the buffers that do not grow with it.
    constexpr uint32_t kMany = 1u << 24;
    uint64_t others = 0;
    for (const BufferPlan& plan : planBuffers(scene, {kMany, 1, {}}, estimator, {}))
        if (plan.name != "film") others += plan.bytes;
    return others < device.memory ? (device.memory - others) / sizeof(gpu::PixelState) : 0;
}

bool haveRoomForTextures(const vulkan::DeviceDescription& device, const GpuScene& scene) {
    // Where texel buffers are too small, rows are in storage buffers.
    const uint64_t limit = std::min(std::max(bindingLimit(device, BufferUse::Storage).bytes,
                                             bindingLimit(device, BufferUse::Texel).bytes),
                                    device.largestAllocation);
    uint64_t all = 0;
    for (const BufferPlan& plan : planSceneBuffers(scene, {}))
        all += plan.bytes;
    return sizeOf(scene.details) <= limit && all <= device.memory;
}

void checkMemory(const vulkan::DeviceDescription& device, const GpuScene& scene,
                 const PictureArea& area, const Estimator& estimator, const DeviceTuning& tuning) {
    const std::vector<BufferPlan> plans = planBuffers(scene, area, estimator, tuning);
    for (BufferPlan plan : plans) {
        if (plan.name == "film")
            plan.bytes =
                std::min(plan.bytes, pixelsPerSegment(device, tuning) * sizeof(gpu::PixelState));
        requireFits(device, plan);
    }
    requireTogetherFit(device, plans);
}

} // namespace stromboli
