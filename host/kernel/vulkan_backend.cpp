#include "host/kernel/vulkan_backend.hpp"

#include "host/core/error.hpp"
#include "host/kernel/frame.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/work_order.hpp"

#include "embedded/pathtrace_storage.h"
#include "embedded/pathtrace_texel.h"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

/// llvmpipe ends all loops of a group, silently, after 65,535 passes of any loop.
constexpr uint32_t kLlvmpipeLoopPasses = 65535;
/// On other devices only a guard against endless loops: a ray through 2^20 nodes is none.
constexpr uint32_t kGuardIterations = 1u << 20;

/// One pass of the kernel's loop counts for itself, its traversal steps, the loop around it that
/// changes pixels and, where there are such, the loops that look for ambient light and walk a light
/// tree.
uint32_t hardLimit(const vulkan::Device& device, const GpuScene& scene,
                   const DeviceTuning& tuning) {
    if (!device.description().isCpu()) return kGuardIterations;
    const bool ambient =
        tuning.everythingOn ||
        std::any_of(scene.lights.begin(), scene.lights.end(),
                    [](const gpu::Light& l) { return l.kind == gpu::LIGHT_AMBIENT; });
    const uint32_t perIteration = 1 + (tuning.traversalSteps + 1) + 2 +
                                  (ambient ? scene.areaLights + 1 : 0) +
                                  (scene.manyLampTriangles ? scene.lightTreeLevels + 1 : 0);
    return std::max(kLlvmpipeLoopPasses / perIteration, 2u);
}

/// Where lanes stop taking path rays. What is left has to do for one more surface with all its
/// direct light samples: a pass or more for each.
uint32_t softLimit(uint32_t hard, const gpu::Frame& frame) {
    const uint32_t directSamples = frame.areaSamples + frame.deltaLights;
    return directSamples < hard / 32 ? hard / 2 : 1;
}

/// Iterations a dispatch may be given. Where threads share them, a fast one runs more of them in a
/// group than the others: up to twice as many.
uint32_t paceLimit(uint32_t soft, const DeviceTuning& tuning) {
    return tuning.driverThreads > 0 ? std::max(soft / 2, 1u) : soft;
}

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& v) {
    return std::as_bytes(std::span(v));
}

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

std::vector<vulkan::Binding> kernelBindings(bool texelFetch) {
    std::vector<vulkan::Binding> bindings;
    for (uint32_t i = 0; i < BINDING_COUNT; ++i) {
        // The film and the work list are read and written row by row as well.
        const bool rows = i < SCENE_BINDING_COUNT || i == BINDING_WORK_ITEMS || i == BINDING_PIXELS;
        bindings.push_back({i, rows && texelFetch   ? BufferUse::Texel
                               : i == BINDING_FRAME ? BufferUse::Uniform
                                                    : BufferUse::Storage});
    }
    return bindings;
}

std::span<const uint32_t> kernelCode(bool texelFetch) {
    return texelFetch ? std::span<const uint32_t>(pathtrace_texel)
                      : std::span<const uint32_t>(pathtrace_storage);
}

RenderSettings withCrop(RenderSettings s) {
    if (s.crop.width == 0) s.crop = {0, 0, s.width, s.height};
    return s;
}

/// No more lanes or items than there are pixels.
DeviceTuning tuningFor(const KernelTuning& tuning, const vulkan::Device& device,
                       const GpuScene& scene, const RenderSettings& settings) {
    DeviceTuning t = resolve(tuning, device, largestRowBuffer(scene, pixelCount(settings)));
    t.lanes = uint32_t(std::min<uint64_t>(t.lanes, pixelCount(settings)));
    t.itemsPerDispatch = uint32_t(std::min<uint64_t>(t.itemsPerDispatch, pixelCount(settings)));
    return t;
}

} // namespace

VulkanBackend::VulkanBackend(const vulkan::Device& device, const GpuScene& scene,
                             const Camera& camera, const RenderSettings& settings,
                             const KernelTuning& tuning)
    : device_(device), settings_(withCrop(settings)), frame_(makeFrame(scene, camera, settings_)),
      tuning_(tuningFor(tuning, device, scene, settings_)),
      features_(kernelFeatures(scene, camera, settings_, tuning_)),
      hardIterations_(hardLimit(device, scene, tuning_)),
      softIterations_(softLimit(hardIterations_, frame_)), fixedIterations_(tuning.fixedIterations),
      pace_(tuning.targetSeconds, paceLimit(softIterations_, tuning_)), queue_(device),
      sceneBuffers_([&] {
          checkMemory(device.description(), scene, settings_, tuning_);
          std::vector<Buffer> buffers;
          for (const vulkan::BufferPlan& b : planSceneBuffers(scene, tuning_))
              buffers.emplace_back(device, b.name, b.bytes, b.use);
          return buffers;
      }()),
      frameBuffer_(device, "frame constants", sizeof(gpu::Frame), BufferUse::Uniform),
      workItems_(device, "work list", tuning_.itemsPerDispatch * sizeof(gpu::WorkItem),
                 rowUse(tuning_)),
      suspended_(device, "suspended paths", tuning_.lanes * sizeof(gpu::SuspendedPath),
                 BufferUse::Storage),
      splits_(device, "splits of suspended paths",
              splitCount(settings_, tuning_.lanes) * sizeof(gpu::SuspendedSplit),
              BufferUse::Storage),
      status_(device, "dispatch status", sizeof(gpu::DispatchStatus), BufferUse::Storage),
      pipeline_(device, tuning.code.empty() ? kernelCode(tuning_.texelFetch) : tuning.code,
                kernelBindings(tuning_.texelFetch), features_, sizeof(gpu::Dispatch)) {
    sceneBuffers_[BINDING_RECORDS].upload(queue_, bytesOf(scene.bvh.records));
    sceneBuffers_[BINDING_PRIMITIVES].upload(queue_, bytesOf(scene.primitives));
    sceneBuffers_[BINDING_MATERIALS].upload(queue_, bytesOf(scene.materials));
    sceneBuffers_[BINDING_LIGHTS].upload(queue_, bytesOf(scene.lights));
    sceneBuffers_[BINDING_EMITTER_ENTRIES].upload(queue_, bytesOf(scene.emitterEntries));
    frameBuffer_.upload(queue_, bytesOf(frame_));
    gpu::SuspendedPath none{};
    none.bounce = gpu::SUSPENDED_NONE;
    none.item = gpu::NO_ITEM;
    suspended_.upload(queue_, bytesOf(std::vector(tuning_.lanes, none)));
    createSegments();
}

void VulkanBackend::createSegments() {
    const uint64_t total = pixelCount(settings_);
    const uint64_t perSegment = pixelsPerSegment(device_.description(), tuning_);
    for (uint64_t first = 0; first < total; first += perSegment) {
        const auto count = uint32_t(std::min(perSegment, total - first));
        Segment& s = segments_.emplace_back(Segment{
            uint32_t(first), count,
            Buffer(device_, "film", uint64_t(count) * sizeof(gpu::PixelState), rowUse(tuning_)),
            nullptr});
        gpu::PixelState empty{};
        empty.firstRejected = 0xFFFFFFFFu;
        s.pixels.upload(queue_, bytesOf(std::vector(count, empty)));
    }
    for (Segment& s : segments_) {
        std::vector<const Buffer*> buffers;
        for (const Buffer& b : sceneBuffers_)
            buffers.push_back(&b);
        for (const Buffer* b :
             {&frameBuffer_, &workItems_, &s.pixels, &suspended_, &status_, &splits_})
            buffers.push_back(b);
        s.set = std::make_unique<vulkan::DescriptorSet>(device_, pipeline_, buffers);
    }
}

uint32_t VulkanBackend::cropPixel(uint32_t pixel) const {
    const Crop& c = settings_.crop;
    return (pixel / settings_.width - c.y) * c.width + pixel % settings_.width - c.x;
}

uint32_t VulkanBackend::picturePixel(uint32_t pixel) const {
    const Crop& c = settings_.crop;
    return (pixel / c.width + c.y) * settings_.width + pixel % c.width + c.x;
}

void VulkanBackend::sample(std::span<const PixelTarget> targets, Film& film,
                           const PassProgress& progress) {
    const std::vector<PixelTarget> order = tileOrder(targets, settings_.width);
    std::vector<std::vector<gpu::WorkItem>> work(segments_.size());
    const uint32_t perSegment = segments_.front().pixelCount;
    for (const PixelTarget& t : order) {
        const uint32_t pixel = cropPixel(t.pixel);
        work[pixel / perSegment].push_back(
            {pixel % perSegment, t.samples, t.pixel % settings_.width, t.pixel / settings_.width});
    }
    uint64_t done = 0;
    const auto advance = [&](uint64_t samples) {
        done += samples;
        return !progress || progress(done);
    };
    bool goOn = true;
    for (size_t i = 0; i < segments_.size(); ++i) {
        const std::span<const gpu::WorkItem> items = work[i];
        for (size_t first = 0; first < items.size() && goOn; first += tuning_.itemsPerDispatch)
            goOn = runChunk(segments_[i],
                            items.subspan(first, std::min<size_t>(tuning_.itemsPerDispatch,
                                                                  items.size() - first)),
                            advance);
        readBack(segments_[i], items, film);
    }
}

/// With a pixel state and frame constants of its own, which are put back at the end.
SampleValue VulkanBackend::sampleAlone(uint32_t pixel, uint32_t sample) {
    const uint32_t inCrop = cropPixel(pixel), perSegment = segments_.front().pixelCount;
    Segment& segment = segments_[inCrop / perSegment];
    const gpu::WorkItem item = {inCrop % perSegment, 1, pixel % settings_.width,
                                pixel / settings_.width};
    gpu::Frame frame = frame_;
    frame.firstSample = sample;
    frame.keepsValue = 1;
    frameBuffer_.upload(queue_, bytesOf(frame));
    const uint64_t offset = uint64_t(item.pixel) * sizeof(gpu::PixelState);
    gpu::PixelState before{}, state{};
    segment.pixels.download(queue_, std::as_writable_bytes(std::span(&before, 1)), offset);
    segment.pixels.upload(queue_, bytesOf(state), offset);
    runChunk(segment, std::span(&item, 1), [](uint64_t) { return true; });
    segment.pixels.download(queue_, std::as_writable_bytes(std::span(&state, 1)), offset);
    segment.pixels.upload(queue_, bytesOf(before), offset);
    frameBuffer_.upload(queue_, bytesOf(frame_));
    return {state.sum, state.rejected > 0};
}

/// Dispatches until every item of the chunk has its samples; false if asked to stop.
bool VulkanBackend::runChunk(const Segment& segment, std::span<const gpu::WorkItem> items,
                             const std::function<bool(uint64_t)>& advance) {
    workItems_.upload(queue_, std::as_bytes(items));
    gpu::DispatchStatus status{};
    do {
        dispatch(segment, uint32_t(items.size()), status);
        count(status);
        if (status.overflowedItems > 0)
            throw DeviceError(fmt::format(
                "{} pixels needed more than {} loop iterations for one surface, the most that {} "
                "runs in a dispatch: too many lamps or light samples (-l) for one shading point",
                status.overflowedItems, hardIterations_, device_.description().name()));
        if (!advance(status.samples)) return false;
    } while (status.unfinishedItems > 0 || status.nextItem < items.size());
    return true;
}

gpu::Dispatch VulkanBackend::dispatchConstants(const Segment& segment, uint32_t itemCount,
                                               uint32_t groups) const {
    gpu::Dispatch d{};
    d.itemCount = itemCount;
    d.segmentBase = segment.firstPixel;
    d.softIterations = softIterations_;
    d.hardIterations = hardIterations_;
    d.laneCount = tuning_.lanes;
    if (tuning_.driverThreads == 0 || fixedIterations_) {
        d.softIterations = fixedIterations_.value_or(pace_.iterations());
        return d;
    }
    d.groupsPerThread = std::max(groups / tuning_.driverThreads, 1u);
    d.sharedIterations = pace_.iterations() * tuning_.workgroupSize * tuning_.driverThreads;
    return d;
}

/// `status`: what the dispatch before this one left; then what this one leaves.
void VulkanBackend::dispatch(const Segment& segment, uint32_t itemCount,
                             gpu::DispatchStatus& status) {
    const uint32_t groups = (tuning_.lanes + tuning_.workgroupSize - 1) / tuning_.workgroupSize;
    const gpu::Dispatch constants = dispatchConstants(segment, itemCount, groups);
    // Lanes that find the list empty count on; started anew, the count cannot wrap around.
    status = {.nextItem = std::min(status.nextItem, itemCount)};
    status_.upload(queue_, bytesOf(status));
    const double seconds = queue_.run("run the path kernel", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device_, commands, pipeline_, *segment.set, bytesOf(constants),
                               groups);
    });
    pace_.took(seconds);
    kernelSeconds_ += seconds;
    status_.download(queue_, std::as_writable_bytes(std::span(&status, 1)));
}

void VulkanBackend::count(const gpu::DispatchStatus& status) {
    counters_.rays += status.rays;
    counters_.paths += status.samples;
    steps_.busy += status.busySteps;
    steps_.all += status.allSteps;
}

void VulkanBackend::readBack(const Segment& segment, std::span<const gpu::WorkItem> items,
                             Film& film) {
    if (items.empty()) return;
    std::vector<gpu::PixelState> states(segment.pixelCount);
    segment.pixels.download(queue_, std::as_writable_bytes(std::span(states)));
    for (const gpu::WorkItem& item : items) {
        const gpu::PixelState& s = states[item.pixel];
        PixelStatistics& p = film.pixels[picturePixel(segment.firstPixel + item.pixel)];
        p.count = s.count;
        p.rejected = s.rejected;
        p.firstRejected = s.firstRejected;
        if (s.count == 0) continue;
        p.mean = (glm::dvec3(s.sum) + glm::dvec3(s.sumError)) / double(s.count);
        p.m2 = glm::dvec3(s.m2) + glm::dvec3(s.m2Error);
    }
}

} // namespace stromboli
