#include "host/kernel/kernel_buffers.hpp"

#include "host/kernel/path_kernel.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "host/render/kept_pixels.hpp"
#include "shaders/shared/interface.h"
#include "shaders/shared/wavefront_types.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace stromboli {

// --- Plans of buffers ----------------------------------------------------------------------------

using vulkan::BufferPlan;
using vulkan::BufferUse;

namespace {

template <class Array>
uint64_t sizeOf(const Array& a) {
    return a.size() * sizeof(typename Array::value_type);
}

/// What may be large, in pages that a device can read where they lie; null: what has to be copied.
const RowPages* pagesOf(const GpuScene& scene, uint32_t binding) {
    if (binding == BINDING_DETAIL) return &scene.details.rows;
    if (binding == BINDING_ENVIRONMENT && scene.lights.environment)
        return scene.lights.environment->texels.get();
    return nullptr;
}

} // namespace

vulkan::BufferUse rowUse(const DeviceTuning& tuning) {
    return tuning.texelFetch ? BufferUse::Texel : BufferUse::Storage;
}

std::vector<BufferPlan> planSceneBuffers(const GpuScene& scene, const DeviceTuning& tuning) {
    const BufferUse rows = rowUse(tuning);
    const auto inPages = [&](uint32_t binding) { return pagesOf(scene, binding) != nullptr; };
    return {{"BVH buffer", sizeOf(scene.bvh.records), rows},
            {"primitive buffer", sizeOf(scene.primitives), rows},
            {"material buffer", sizeOf(scene.materials), rows},
            {"light buffer", sizeOf(scene.lights.lights), rows},
            {"light table", sizeOf(scene.lights.table), rows},
            {"environment",
             scene.lights.environmentRows().size_bytes(),
             rows,
             {},
             inPages(BINDING_ENVIRONMENT)},
            {"texture buffer", sizeOf(scene.details.rows), rows,
             "--max-texture N makes textures smaller", inPages(BINDING_DETAIL)}};
}

uint64_t largestSceneBuffer(const GpuScene& scene) {
    uint64_t most = 0;
    for (const BufferPlan& plan : planSceneBuffers(scene, {}))
        most = std::max(most, plan.bytes);
    return most;
}

uint64_t largestRowBuffer(const GpuScene& scene, uint64_t pixels) {
    const uint64_t items = std::min<uint64_t>(DeviceTuning{}.itemsPerDispatch, pixels);
    const uint64_t guide = scene.guide ? sizeOf(scene.guide->rows) : 0;
    return std::max({largestSceneBuffer(scene), items * sizeof(gpu::WorkItem), guide});
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
    const uint64_t states = area.pixelCount() * tuning.strands;
    const uint64_t items = std::min<uint64_t>(tuning.itemsPerDispatch, states);
    const uint64_t lanes = std::min<uint64_t>(tuning.lanes, states);
    const BufferUse rows = rowUse(tuning);
    std::vector<BufferPlan> plans = planSceneBuffers(scene, tuning);
    plans.push_back({"film", states * sizeof(gpu::PixelState), rows});
    plans.push_back({"work list", items * sizeof(gpu::WorkItem), rows});
    // What a path has does not depend on the camera.
    const PathBuffers paths =
        pathBuffers(kernelFeatures(scene, Camera{}, estimator, tuning), lanes, tuning.scheduler);
    plans.push_back(paths.paths);
    if (paths.queues) plans.push_back(*paths.queues);
    plans.push_back({"pixel filter", filterRows(estimator.filter) * sizeof(Row), rows});
    if (guidesLight(scene, estimator))
        plans.push_back({"light guide", scene.guide->rows.size() * sizeof(Row), rows});
    if (aimsBounces(scene, estimator))
        plans.push_back({"lit cells", scene.lit->rowCount() * sizeof(Row), rows});
    if (looksAtShadowMap(scene, estimator))
        plans.push_back(
            {"shadow map", size_t(gpu::SHADOW_MAP_SIDE) * gpu::SHADOW_MAP_SIDE * 4, rows});
    plans.push_back({"frame constants", sizeof(gpu::Frame), BufferUse::Uniform});
    plans.push_back({"dispatch status", sizeof(gpu::DispatchStatus), BufferUse::Storage});
    return plans;
}

uint64_t pixelsPerSegment(const vulkan::DeviceDescription& device, const DeviceTuning& tuning) {
    constexpr uint64_t kMostPixels = uint64_t(1) << 24; // 1 GiB
    const uint64_t bytes =
        std::min(bindingLimit(device, rowUse(tuning)).bytes, device.largestAllocation);
    return std::min(bytes / sizeof(gpu::PixelState), kMostPixels) / tuning.strands;
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
    return sizeOf(scene.details.rows) <= limit && all <= device.memory;
}

void checkMemory(const vulkan::DeviceDescription& device, const GpuScene& scene,
                 const PictureArea& area, const Estimator& estimator, const DeviceTuning& tuning) {
    const std::vector<BufferPlan> plans = planBuffers(scene, area, estimator, tuning);
    for (BufferPlan plan : plans) {
        if (plan.name == "film")
            plan.bytes = std::min(plan.bytes, pixelsPerSegment(device, tuning) * tuning.strands *
                                                  sizeof(gpu::PixelState));
        requireFits(device, plan);
    }
    requireTogetherFit(device, plans);
}

// --- The scene on the device ---------------------------------------------------------------------

namespace {

template <class Array>
std::span<const std::byte> bytesOf(const Array& a) {
    return std::as_bytes(std::span(a));
}

constexpr size_t kBuffers = 7;

/// What a scene has for each of its bindings.
std::array<std::span<const std::byte>, kBuffers> contentsOf(const GpuScene& scene) {
    std::array<std::span<const std::byte>, kBuffers> contents;
    contents[BINDING_RECORDS] = bytesOf(scene.bvh.records);
    contents[BINDING_PRIMITIVES] = bytesOf(scene.primitives);
    contents[BINDING_MATERIALS] = bytesOf(scene.materials);
    contents[BINDING_LIGHTS] = bytesOf(scene.lights.lights);
    contents[BINDING_LIGHT_TABLE] = bytesOf(scene.lights.table);
    contents[BINDING_ENVIRONMENT] = std::as_bytes(scene.lights.environmentRows());
    contents[BINDING_DETAIL] = bytesOf(scene.details.rows);
    return contents;
}

/// Whether a buffer with the contents `a` serves for `b`. One that reads the array itself does not
/// outlive it.
bool serves(const vulkan::Buffer& buffer, std::span<const std::byte> a,
            std::span<const std::byte> b) {
    if (a.data() == b.data()) return a.size() == b.size();
    return !buffer.readsHost() && std::ranges::equal(a, b);
}

} // namespace

DeviceScene::DeviceScene(const vulkan::Device& device, const GpuScene& scene,
                         const DeviceTuning& tuning, SceneBuffers filled)
    : scene_(scene), isFetchedAsTexels_(tuning.texelFetch) {
    vulkan::Queue queue(device);
    const auto contents = contentsOf(scene);
    const std::vector<vulkan::BufferPlan> plans = planSceneBuffers(scene, tuning);
    for (uint32_t binding = 0; binding < kBuffers; ++binding) {
        const vulkan::BufferPlan& plan = plans.at(binding);
        const auto found = filled.find(binding);
        if (found != filled.end() && found->second.use() == plan.use) {
            buffers_.push_back(std::move(found->second));
            continue;
        }
        filled.erase(binding); // before the memory of the next is asked for
        if (const RowPages* pages = pagesOf(scene, binding)) {
            buffers_.emplace_back(device, plan.name, *pages, plan.use);
        } else {
            buffers_.emplace_back(device, plan.name, plan.bytes, plan.use);
            buffers_.back().upload(queue, contents[binding]);
        }
    }
}

SceneBuffers DeviceScene::releaseWhatIsAlsoIn(const GpuScene& next) {
    SceneBuffers filled;
    const auto contents = contentsOf(scene_), others = contentsOf(next);
    for (uint32_t binding = 0; binding < kBuffers; ++binding)
        if (serves(buffers_[binding], contents[binding], others[binding]))
            filled.emplace(binding, std::move(buffers_[binding]));
    buffers_.clear();
    return filled;
}

SceneBuffers DeviceScene::releaseAllBut(std::span<const uint32_t> changed) {
    SceneBuffers filled;
    for (uint32_t binding = 0; binding < kBuffers; ++binding)
        if (std::ranges::find(changed, binding) == changed.end())
            filled.emplace(binding, std::move(buffers_[binding]));
    buffers_.clear();
    return filled;
}

// --- The film on the device ----------------------------------------------------------------------

namespace {

/// What of a run lies in a segment, counted in it.
PixelRun partOf(const FilmSegment& segment, PixelRun run) {
    const uint32_t first = std::max(run.first, segment.firstPixel);
    const uint32_t end = std::min(run.first + run.count, segment.firstPixel + segment.pixelCount);
    if (end <= first) return {};
    return {first - segment.firstPixel, end - first};
}

} // namespace

DeviceFilm::DeviceFilm(const vulkan::Device& device, const PictureArea& area,
                       const DeviceTuning& tuning)
    : area_(area), strands_(tuning.strands), queue_(device) {
    const uint64_t total = area.pixelCount();
    const uint64_t perSegment = pixelsPerSegment(device.description(), tuning);
    for (uint64_t first = 0; first < total; first += perSegment) {
        const auto count = uint32_t(std::min(perSegment, total - first));
        FilmSegment& s = segments_.emplace_back(FilmSegment{
            uint32_t(first), count,
            vulkan::Buffer(device, "film", uint64_t(count) * strands_ * sizeof(gpu::PixelState),
                           rowUse(tuning))});
        s.pixels.clear(queue_);
    }
}

std::pair<size_t, uint32_t> DeviceFilm::firstStrandOf(uint32_t pixel) const {
    const uint32_t perSegment = segments_.front().pixelCount;
    return {pixel / perSegment, pixel % perSegment * strands_};
}

std::vector<std::vector<gpu::WorkItem>>
DeviceFilm::workOf(std::span<const PixelTarget> targets) const {
    std::vector<std::vector<gpu::WorkItem>> work(segments_.size());
    for (const PixelTarget& t : targets) {
        const auto [segment, first] = firstStrandOf(t.pixel);
        const PixelPlace place = area_.placeOf(t.pixel);
        for (uint32_t strand = 0; strand < std::min(strands_, t.samples); ++strand) {
            const uint32_t samples = (t.samples - strand - 1) / strands_ + 1;
            work[segment].push_back({first + strand, samples, place.x, place.y});
        }
    }
    return work;
}

gpu::PixelState DeviceFilm::read(size_t segment, uint32_t index) {
    gpu::PixelState state{};
    segments_[segment].pixels.download(queue_, std::as_writable_bytes(std::span(&state, 1)),
                                       uint64_t(index) * sizeof(gpu::PixelState));
    return state;
}

void DeviceFilm::write(size_t segment, uint32_t index, const gpu::PixelState& state) {
    segments_[segment].pixels.upload(queue_, std::as_bytes(std::span(&state, 1)),
                                     uint64_t(index) * sizeof(gpu::PixelState));
}

std::span<const gpu::PixelState> DeviceFilm::statesOf(const FilmSegment& segment, PixelRun run) {
    const size_t first = size_t(run.first) * strands_, count = size_t(run.count) * strands_;
    if (const std::byte* view = segment.pixels.hostView())
        return {reinterpret_cast<const gpu::PixelState*>(view) + first, count};
    copy_.resize(count);
    segment.pixels.download(queue_, std::as_writable_bytes(std::span(copy_)),
                            first * sizeof(gpu::PixelState));
    return copy_;
}

void DeviceFilm::readBack(size_t index, std::span<const gpu::WorkItem> items, Film& film) {
    if (items.empty()) return;
    const FilmSegment& segment = segments_[index];
    const auto [least, most] = std::ranges::minmax(items, {}, &gpu::WorkItem::pixel);
    const uint32_t first = least.pixel / strands_, end = most.pixel / strands_ + 1;
    const std::span<const gpu::PixelState> states = statesOf(segment, {first, end - first});
    tbb::parallel_for(tbb::blocked_range<size_t>(0, items.size(), 4096), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
            if (items[i].pixel % strands_ != 0) continue; // the first has the samples that it has
            const uint32_t pixel = items[i].pixel / strands_;
            film.pixels[segment.firstPixel + pixel] =
                statisticsOf(states.subspan(size_t(pixel - first) * strands_, strands_));
        }
    });
}

void DeviceFilm::clear() {
    for (FilmSegment& segment : segments_)
        segment.pixels.clear(queue_);
}

KeptPixels DeviceFilm::save(PixelRun run) {
    KeptPixels kept{KeptPixels::As::States, strands_, {}};
    kept.bytes.reserve(run.count * kept.bytesPerPixel());
    for (const FilmSegment& segment : segments_)
        if (const PixelRun part = partOf(segment, run); part.count > 0)
            kept.append(statesOf(segment, part));
    return kept;
}

void DeviceFilm::restore(PixelRun run, const KeptPixels& pixels, Film& film) {
    if (!pixels.sameKind({KeptPixels::As::States, strands_, {}}) || pixels.count() != run.count ||
        uint64_t(run.first) + run.count > area_.pixelCount())
        throw std::invalid_argument("the saved film is not of this area");
    for (FilmSegment& segment : segments_) {
        const PixelRun part = partOf(segment, run);
        if (part.count == 0) continue;
        const uint32_t first = segment.firstPixel + part.first;
        const auto states = pixels.states().subspan(size_t(first - run.first) * strands_,
                                                    size_t(part.count) * strands_);
        segment.pixels.upload(queue_, std::as_bytes(states),
                              uint64_t(part.first) * strands_ * sizeof(gpu::PixelState));
        for (uint32_t i = 0; i < part.count; ++i)
            film.pixels[first + i] = statisticsOf(states.subspan(size_t(i) * strands_, strands_));
    }
}

} // namespace stromboli
