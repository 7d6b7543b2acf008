#include "host/kernel/dispatcher.hpp"

#include "host/core/error.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/loop_limit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

/// One iteration of the kernel's loop counts for itself, its traversal steps and pixel filter, the
/// loop around it that changes pixels and, where there are such, the walk down the light tree and
/// the loose textures of a material.
uint32_t hardLimit(const vulkan::Device& device, const GpuScene& scene, const PathKernel& kernel) {
    // At a hit, where a path splits again, and at the end of a ray of hemisphere sampling.
    constexpr uint32_t kTextureLoops = 3;
    // A light is picked for a light sample, and looked up once more for MIS.
    const uint32_t perIteration =
        1 + passesOfCameraRays(kernel.features()) + 2 +
        (scene.lights.groups ? 2 * (scene.lights.levels + 1) : 0) +
        (scene.mostTextures ? kTextureLoops * (scene.mostTextures + 1) : 0);
    return loopLimit(device, perIteration);
}

Buffer bufferOf(const vulkan::Device& device, const vulkan::BufferPlan& plan) {
    return {device, plan.name, plan.bytes, plan.use};
}

PathBuffers pathBuffers(const PathKernel& kernel, const DispatchSettings& s) {
    return pathBuffers(kernel.features(), s.tuning.lanes, s.tuning.scheduler);
}

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

} // namespace

Dispatcher::Dispatcher(const DispatchTarget& target, const PathKernel& kernel,
                       const DispatchSettings& settings)
    : device_(target.device), tuning_(settings.tuning),
      hardIterations_(hardLimit(device_, target.scene.scene(), kernel)), queue_(device_),
      paths_(bufferOf(device_, pathBuffers(kernel, settings).paths)), film_(target.film),
      fixedIterations_(settings.fixedIterations),
      frameBuffer_(device_, "frame constants", sizeof(gpu::Frame), BufferUse::Uniform),
      workItems_(device_, "work list", tuning_.itemsPerDispatch * sizeof(gpu::WorkItem),
                 rowUse(tuning_)),
      status_(device_, "dispatch status", sizeof(gpu::DispatchStatus), BufferUse::Storage) {
    if (const auto queues = pathBuffers(kernel, settings).queues)
        queues_.emplace(bufferOf(device_, *queues));
    setFrame(settings.frame);
    for (const DeviceFilm::Segment& s : target.film.segments()) {
        std::vector<const Buffer*> buffers;
        for (const Buffer& b : target.scene.buffers())
            buffers.push_back(&b);
        buffers.insert(buffers.end(),
                       {&frameBuffer_, &workItems_, &s.pixels, &paths_, &status_, &target.filter});
        if (queues_) buffers.push_back(&*queues_);
        sets_.push_back(
            std::make_unique<vulkan::DescriptorSet>(device_, kernel.pipeline(), buffers));
    }
}

void Dispatcher::setFrame(const gpu::Frame& frame) {
    frameBuffer_.upload(queue_, bytesOf(frame));
}

bool Dispatcher::run(size_t segment, std::span<const gpu::WorkItem> items,
                     const std::function<bool(uint64_t)>& advance) {
    for (size_t first = 0; first < items.size(); first += tuning_.itemsPerDispatch) {
        const size_t count = std::min<size_t>(tuning_.itemsPerDispatch, items.size() - first);
        if (!runChunk(segment, items.subspan(first, count), advance)) return false;
    }
    return true;
}

bool Dispatcher::runChunk(size_t segment, std::span<const gpu::WorkItem> items,
                          const std::function<bool(uint64_t)>& advance) {
    workItems_.upload(queue_, std::as_bytes(items));
    gpu::DispatchStatus status{};
    bool goesOn = true;
    const auto somethingIsLeft = [&] {
        return status.unfinishedItems > 0 || (goesOn && status.nextItem < items.size());
    };
    Share share{.segment = segment, .itemCount = uint32_t(items.size()), .isFirst = true};
    do {
        share.isEnding = !goesOn && !share.ends;
        share.ends = !goesOn;
        dispatch(share, status);
        share.isFirst = false;
        count(status);
        if (status.overflowedItems > 0)
            throw DeviceError(fmt::format(
                "{} pixels needed more than {} loop iterations for one surface, the most that {} "
                "runs in a dispatch: too many lights or light samples (-l) for one shading point, "
                "or "
                "too many transparent layers behind each other",
                status.overflowedItems, hardIterations_, device_.description().name()));
        goesOn = advance(status.samples) && goesOn;
    } while (somethingIsLeft());
    return goesOn;
}

gpu::Dispatch Dispatcher::constants(const Share& share) const {
    gpu::Dispatch d{};
    d.itemCount = share.itemCount;
    d.segmentBase = film_.segments()[share.segment].firstPixel;
    d.hardIterations = hardIterations_;
    d.laneCount = tuning_.lanes;
    d.beginsNoSample = share.ends;
    return d;
}

/// `status`: what the submission before this one left; then what this one leaves.
void Dispatcher::dispatch(const Share& share, gpu::DispatchStatus& status) {
    // Lanes that find the list empty count on; started anew, the count cannot wrap around.
    status = {.nextItem = std::min(status.nextItem, share.itemCount)};
    status_.upload(queue_, bytesOf(status));
    const double seconds = queue_.run("run the path kernel",
                                      [&](VkCommandBuffer commands) { record(commands, share); });
    kernelSeconds_ += seconds;
    status_.download(queue_, std::as_writable_bytes(std::span(&status, 1)));
    hasRun(seconds, status);
}

void Dispatcher::count(const gpu::DispatchStatus& status) {
    counters_.rays += status.rays;
    counters_.paths += status.samples;
    steps_.busy += status.busySteps;
    steps_.all += status.allSteps;
}

} // namespace stromboli
