#include "host/kernel/vulkan_backend.hpp"

#include "host/core/error.hpp"
#include "host/kernel/frame.hpp"
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

/// One pass of the kernel's loop counts for itself, its traversal steps, the service loop and,
/// where there is ambient light, the loop that looks for it.
uint32_t hardLimit(const vulkan::Device& device, const GpuScene& scene, uint32_t steps) {
    if (!device.description().isCpu()) return kGuardIterations;
    const bool ambient =
        std::any_of(scene.lights.begin(), scene.lights.end(),
                    [](const gpu::Light& l) { return l.kind == gpu::LIGHT_AMBIENT; });
    const uint32_t perIteration = 1 + (steps + 1) + 2 + (ambient ? scene.areaLights + 1 : 0);
    return std::max(kLlvmpipeLoopPasses / perIteration, 2u);
}

/// Where lanes stop taking path rays. What is left has to do for one more surface with all its
/// direct light samples: a pass or more for each.
uint32_t softLimit(uint32_t hard, const gpu::Frame& frame) {
    const uint32_t directSamples = frame.areaSamples + frame.deltaLights;
    return directSamples < hard / 32 ? hard / 2 : 1;
}

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& v) {
    return std::as_bytes(std::span(v));
}

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

template <class T>
uint64_t sizeOf(const std::vector<T>& v) {
    return v.size() * sizeof(T);
}

std::vector<vulkan::Binding> kernelBindings(bool texelFetch) {
    std::vector<vulkan::Binding> bindings;
    for (uint32_t i = 0; i < BINDING_COUNT; ++i) {
        const bool scene = i < SCENE_BINDING_COUNT;
        bindings.push_back({i, scene && texelFetch  ? BufferUse::Texel
                               : i == BINDING_FRAME ? BufferUse::Uniform
                                                    : BufferUse::Storage});
    }
    return bindings;
}

std::span<const uint32_t> kernelCode(bool texelFetch) {
    return texelFetch ? std::span<const uint32_t>(pathtrace_texel)
                      : std::span<const uint32_t>(pathtrace_storage);
}

/// A GPU wants every lane of a big picture at once; llvmpipe is full with a few groups, and
/// smaller dispatches let its lanes run longer within the time target.
uint32_t defaultItems(const vulkan::Device& device) {
    return device.description().isCpu() ? 1u << 14 : kLargestDispatch;
}

DeviceTuning deviceTuning(const KernelTuning& t) {
    DeviceTuning tuning;
    tuning.workgroupSize = t.workgroupSize.value_or(tuning.workgroupSize);
    tuning.traversalSteps = t.traversalSteps.value_or(tuning.traversalSteps);
    return tuning;
}

std::vector<BufferSize> sceneSizes(const GpuScene& scene) {
    return {{"BVH node buffer", sizeOf(scene.bvh.nodes)},
            {"primitive buffer", sizeOf(scene.primitives)},
            {"normal buffer", sizeOf(scene.normals)},
            {"material buffer", sizeOf(scene.materials)},
            {"light buffer", sizeOf(scene.lights)},
            {"emitter table", sizeOf(scene.emitterEntries)}};
}

uint64_t pixelCount(const RenderSettings& s) {
    return s.crop.width ? uint64_t(s.crop.width) * s.crop.height : uint64_t(s.width) * s.height;
}

RenderSettings withCrop(RenderSettings s) {
    if (s.crop.width == 0) s.crop = {0, 0, s.width, s.height};
    return s;
}

/// Says what does not fit before anything is allocated or uploaded.
void checkMemory(const vulkan::Device& device, const GpuScene& scene,
                 const RenderSettings& settings, uint32_t itemsPerDispatch, BufferUse use) {
    for (const BufferSize& b : sceneSizes(scene))
        Buffer::checkLimits(device, b.name, b.bytes, use);
    uint64_t total = 0;
    for (const BufferSize& b : predictBuffers(scene, settings, itemsPerDispatch))
        total += b.bytes;
    if (total > device.description().memory)
        throw DeviceError(fmt::format("scene and picture need {} bytes, but {} has {} bytes of "
                                      "memory; 'stromboli info' lists the buffers",
                                      total, device.description().name(),
                                      device.description().memory));
}

} // namespace

std::vector<BufferSize> predictBuffers(const GpuScene& scene, const RenderSettings& settings,
                                       uint32_t itemsPerDispatch) {
    const uint64_t items = std::min<uint64_t>(itemsPerDispatch, pixelCount(settings));
    std::vector<BufferSize> sizes = sceneSizes(scene);
    sizes.push_back({"film", pixelCount(settings) * sizeof(gpu::PixelState)});
    sizes.push_back({"work list", items * sizeof(gpu::WorkItem)});
    sizes.push_back({"suspended paths", items * sizeof(gpu::SuspendedPath)});
    sizes.push_back({"frame constants", sizeof(gpu::Frame)});
    sizes.push_back({"dispatch status", sizeof(gpu::DispatchStatus)});
    return sizes;
}

VulkanBackend::VulkanBackend(const vulkan::Device& device, const GpuScene& scene,
                             const Camera& camera, const RenderSettings& settings,
                             const KernelTuning& tuning)
    : device_(device), settings_(withCrop(settings)), frame_(makeFrame(scene, camera, settings_)),
      texelFetch_(tuning.texelFetch.value_or(device.description().isCpu())),
      deviceTuning_(deviceTuning(tuning)),
      features_(kernelFeatures(scene, camera, settings_, deviceTuning_)),
      itemsPerDispatch_(uint32_t(std::min<uint64_t>(
          tuning.itemsPerDispatch.value_or(defaultItems(device)), pixelCount(settings_)))),
      hardIterations_(hardLimit(device, scene, deviceTuning_.traversalSteps)),
      fixedIterations_(tuning.fixedIterations),
      pace_(tuning.targetSeconds, softLimit(hardIterations_, frame_)), queue_(device),
      sceneBuffers_([&] {
          const BufferUse use = texelFetch_ ? BufferUse::Texel : BufferUse::Storage;
          checkMemory(device, scene, settings_, itemsPerDispatch_, use);
          std::vector<Buffer> buffers;
          for (const BufferSize& b : sceneSizes(scene))
              buffers.emplace_back(device, b.name, b.bytes, use);
          return buffers;
      }()),
      frameBuffer_(device, "frame constants", sizeof(gpu::Frame), BufferUse::Uniform),
      workItems_(device, "work list", itemsPerDispatch_ * sizeof(gpu::WorkItem),
                 BufferUse::Storage),
      suspended_(device, "suspended paths", itemsPerDispatch_ * sizeof(gpu::SuspendedPath),
                 BufferUse::Storage),
      status_(device, "dispatch status", sizeof(gpu::DispatchStatus), BufferUse::Storage),
      pipeline_(device, kernelCode(texelFetch_), kernelBindings(texelFetch_), features_,
                sizeof(gpu::Dispatch)) {
    sceneBuffers_[BINDING_NODES].upload(queue_, bytesOf(scene.bvh.nodes));
    sceneBuffers_[BINDING_PRIMITIVES].upload(queue_, bytesOf(scene.primitives));
    sceneBuffers_[BINDING_NORMALS].upload(queue_, bytesOf(scene.normals));
    sceneBuffers_[BINDING_MATERIALS].upload(queue_, bytesOf(scene.materials));
    sceneBuffers_[BINDING_LIGHTS].upload(queue_, bytesOf(scene.lights));
    sceneBuffers_[BINDING_EMITTER_ENTRIES].upload(queue_, bytesOf(scene.emitterEntries));
    frameBuffer_.upload(queue_, bytesOf(frame_));
    gpu::SuspendedPath none{};
    none.bounce = gpu::SUSPENDED_NONE;
    suspended_.upload(queue_, bytesOf(std::vector(itemsPerDispatch_, none)));
    createSegments();
}

void VulkanBackend::createSegments() {
    const uint64_t total = pixelCount(settings_);
    const uint64_t perSegment = std::min<uint64_t>(
        device_.limits().maxStorageBufferRange / sizeof(gpu::PixelState), 1u << 24);
    for (uint64_t first = 0; first < total; first += perSegment) {
        const auto count = uint32_t(std::min(perSegment, total - first));
        Segment& s = segments_.emplace_back(Segment{
            uint32_t(first), count,
            Buffer(device_, "film", uint64_t(count) * sizeof(gpu::PixelState), BufferUse::Storage),
            nullptr});
        gpu::PixelState empty{};
        empty.firstRejected = 0xFFFFFFFFu;
        s.pixels.upload(queue_, bytesOf(std::vector(count, empty)));
    }
    for (Segment& s : segments_) {
        std::vector<const Buffer*> buffers;
        for (const Buffer& b : sceneBuffers_)
            buffers.push_back(&b);
        for (const Buffer* b : {&frameBuffer_, &workItems_, &s.pixels, &suspended_, &status_})
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
    const std::vector<PixelTarget> order = interleave(targets, settings_.width);
    std::vector<std::vector<gpu::WorkItem>> work(segments_.size());
    const uint32_t perSegment = segments_.front().pixelCount;
    for (const PixelTarget& t : order) {
        const uint32_t pixel = cropPixel(t.pixel);
        work[pixel / perSegment].push_back({pixel % perSegment, t.samples});
    }
    uint64_t done = 0;
    const auto advance = [&](uint64_t samples) {
        done += samples;
        return !progress || progress(done);
    };
    bool goOn = true;
    for (size_t i = 0; i < segments_.size(); ++i) {
        const std::span<const gpu::WorkItem> items = work[i];
        for (size_t first = 0; first < items.size() && goOn; first += itemsPerDispatch_)
            goOn = runChunk(
                segments_[i],
                items.subspan(first, std::min<size_t>(itemsPerDispatch_, items.size() - first)),
                advance);
        readBack(segments_[i], items, film);
    }
}

/// Dispatches until every item of the chunk has its samples; false if asked to stop.
bool VulkanBackend::runChunk(const Segment& segment, std::span<const gpu::WorkItem> items,
                             const std::function<bool(uint64_t)>& advance) {
    workItems_.upload(queue_, std::as_bytes(items));
    for (;;) {
        const gpu::DispatchStatus status = dispatch(segment, uint32_t(items.size()));
        counters_.rays += status.rays;
        counters_.paths += status.samples;
        if (status.overflowedItems > 0)
            throw DeviceError(fmt::format(
                "{} pixels needed more than {} loop iterations for one surface, the most that {} "
                "runs in a dispatch: too many lamps or light samples (-l) for one shading point",
                status.overflowedItems, hardIterations_, device_.description().name()));
        if (!advance(status.samples)) return false;
        if (status.unfinishedItems == 0) return true;
    }
}

gpu::DispatchStatus VulkanBackend::dispatch(const Segment& segment, uint32_t itemCount) {
    const gpu::Dispatch constants = {itemCount, segment.firstPixel,
                                     fixedIterations_.value_or(pace_.iterations()),
                                     hardIterations_};
    const uint32_t groups =
        (itemCount + deviceTuning_.workgroupSize - 1) / deviceTuning_.workgroupSize;
    gpu::DispatchStatus status{};
    status_.upload(queue_, bytesOf(status));
    const double seconds = queue_.run("run the path kernel", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device_, commands, pipeline_, *segment.set, bytesOf(constants),
                               groups);
    });
    pace_.took(seconds);
    status_.download(queue_, std::as_writable_bytes(std::span(&status, 1)));
    return status;
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
