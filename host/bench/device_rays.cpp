#include "host/bench/device_rays.hpp"

#include "host/core/error.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/vulkan/queue.hpp"

#include "embedded/trace_rays_storage.h"
#include "embedded/trace_rays_texel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace stromboli::bench {
namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

constexpr uint32_t kBindings = BINDING_RAY_DISTANCES + 1;
/// Of the lanes' totals in their buffer, after the number of the next chunk of rays.
constexpr uint64_t kTotalsOffset = sizeof(uint32_t);

/// The scene's buffers by binding; the traversal reads the first ones only, but all are bound.
auto sceneRows(const GpuScene& scene) {
    const std::array rows = {
        std::as_bytes(std::span(scene.bvh.records)),  std::as_bytes(std::span(scene.primitives)),
        std::as_bytes(std::span(scene.materials)),    std::as_bytes(std::span(scene.lights.lights)),
        std::as_bytes(std::span(scene.lights.table)), std::as_bytes(scene.lights.environmentRows()),
        std::as_bytes(std::span(scene.details))};
    static_assert(rows.size() == SCENE_BINDING_COUNT);
    return rows;
}

std::span<const uint32_t> rayKernel(bool texelFetch) {
    if (texelFetch) return trace_rays_texel;
    return trace_rays_storage;
}

bool isRow(uint32_t binding) {
    return binding < SCENE_BINDING_COUNT || binding == BINDING_RAYS;
}

std::vector<vulkan::Binding> bindings(bool texelFetch) {
    std::vector<vulkan::Binding> all;
    for (uint32_t i = 0; i < kBindings; ++i)
        if (isRow(i) || i > BINDING_RAYS)
            all.push_back({i, isRow(i) && texelFetch ? BufferUse::Texel : BufferUse::Storage});
    return all;
}

} // namespace

uint64_t rowBytes(const GpuScene& scene, uint64_t mostRays) {
    return std::max(largestSceneBuffer(scene), mostRays * sizeof(gpu::TracedRay));
}

RayTuning rayTuning(const vulkan::Device& device, uint64_t rowBytes) {
    RayTuning t = {resolve({}, device, rowBytes), 1};
    if (!device.description().isCpu()) return t;
    // The service pass costs next to nothing here (the path kernel's is dear), so that it comes
    // after every step. Rays per lane: enough that lanes seldom wait for the last rays of others,
    // few enough for the limit of loop passes.
    t.kernel.traversalSteps = 1;
    t.raysPerLane = 64;
    return t;
}

DeviceRays::DeviceRays(const vulkan::Device& device, const GpuScene& scene, const RayTuning& tuning)
    : device_(device), tuning_(tuning), code_(rayKernel(tuning.kernel.texelFetch)), queue_(device) {
    const KernelFeatures features = kernelFeatures(scene, {}, {}, tuning_.kernel);
    constants_.assign(features.begin(), features.end());
    for (const std::span<const std::byte> rows : sceneRows(scene)) {
        Buffer& buffer = sceneBuffers_.emplace_back(device, "scene of the ray kernel", rows.size(),
                                                    tuning_.kernel.texelFetch ? BufferUse::Texel
                                                                              : BufferUse::Storage);
        buffer.upload(queue_, rows);
    }
}

vulkan::ComputePipeline DeviceRays::makePipeline(bool anyHit, bool writeDistances) const {
    std::vector<uint32_t> constants = constants_;
    constants.push_back(anyHit);
    constants.push_back(writeDistances);
    return {device_, code_, bindings(tuning_.kernel.texelFetch), constants,
            sizeof(gpu::RayDispatch)};
}

/// On a CPU device, where a group is a subgroup.
bool DeviceRays::groupsTakeChunks() const {
    return tuning_.kernel.driverThreads > 0 &&
           tuning_.kernel.workgroupSize == device_.description().subgroupSize;
}

void DeviceRays::load(const RaySet& set) {
    rayCount_ = uint32_t(set.rays.size());
    anyHit_ = set.anyHit;
    const uint32_t raysPerGroup = tuning_.kernel.workgroupSize * tuning_.raysPerLane;
    chunks_ = (rayCount_ + raysPerGroup - 1) / raysPerGroup;
    // Of twice the groups a thread may do its own half, or up to all.
    groups_ = groupsTakeChunks() ? 2 * chunks_ : chunks_;
    rays_.emplace(device_, "ray buffer", set.rays.size() * sizeof(gpu::TracedRay),
                  tuning_.kernel.texelFetch ? BufferUse::Texel : BufferUse::Storage);
    rays_->upload(queue_, std::as_bytes(std::span(set.rays)));
    totals_.emplace(device_, "ray totals",
                    kTotalsOffset +
                        groups_ * tuning_.kernel.workgroupSize * sizeof(gpu::LaneTotals),
                    BufferUse::Storage);
    distances_.emplace(device_, "ray distances", rayCount_ * sizeof(float), BufferUse::Storage);
    pipeline_.emplace(makePipeline(anyHit_, false));
    set_ = makeSet(*pipeline_);
}

std::unique_ptr<vulkan::DescriptorSet>
DeviceRays::makeSet(const vulkan::ComputePipeline& pipeline) const {
    std::vector<const Buffer*> buffers;
    for (const Buffer& b : sceneBuffers_)
        buffers.push_back(&b);
    for (const Buffer* b : {&*rays_, &*totals_, &*distances_})
        buffers.push_back(b);
    return std::make_unique<vulkan::DescriptorSet>(device_, pipeline, buffers);
}

double DeviceRays::dispatch(const vulkan::ComputePipeline& pipeline,
                            const vulkan::DescriptorSet& set) {
    gpu::RayDispatch constants{};
    constants.rayCount = rayCount_;
    constants.raysPerLane = tuning_.raysPerLane;
    constants.chunkCount = groupsTakeChunks() ? chunks_ : 0;
    // An iteration counts for itself, its traversal steps and the service loop.
    constants.hardIterations = loopLimit(device_, 1 + (tuning_.kernel.traversalSteps + 1) + 2);
    const uint32_t nextChunk = 0;
    totals_->upload(queue_, std::as_bytes(std::span(&nextChunk, 1)));
    return queue_.run("run the ray kernel", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device_, commands, pipeline, set,
                               std::as_bytes(std::span(&constants, 1)), groups_);
    });
}

RayTotals DeviceRays::trace() {
    const double seconds = dispatch(*pipeline_, *set_);
    std::vector<gpu::LaneTotals> lanes(groups_ * tuning_.kernel.workgroupSize);
    totals_->download(queue_, std::as_writable_bytes(std::span(lanes)), kTotalsOffset);
    RayTotals totals;
    totals.deviceSeconds = device_.description().timestampBits > 0 ? seconds : 0;
    uint64_t unfinished = 0;
    for (const gpu::LaneTotals& lane : lanes) {
        totals.hits += lane.hits;
        totals.distances += double(lane.distances);
        unfinished += lane.unfinished;
    }
    if (unfinished > 0)
        throw DeviceError(fmt::format("the ray kernel did not finish: {} of {} lanes met the limit "
                                      "of loop passes",
                                      unfinished, lanes.size()));
    return totals;
}

std::vector<float> DeviceRays::distances() {
    const vulkan::ComputePipeline pipeline = makePipeline(anyHit_, true);
    dispatch(pipeline, *makeSet(pipeline));
    std::vector<float> result(rayCount_);
    distances_->download(queue_, std::as_writable_bytes(std::span(result)));
    return result;
}

} // namespace stromboli::bench
