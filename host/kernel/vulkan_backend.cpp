#include "host/kernel/vulkan_backend.hpp"

#include "host/kernel/find_occluders.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/recorded_path.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "shaders/shared/layer_types.h"
#include "shaders/shared/medium_types.h"

#include <algorithm>
#include <array>
#include <future>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace stromboli {

// --- The frame -----------------------------------------------------------------------------------

gpu::Frame makeFrame(const GpuScene& scene, const Camera& camera, const PictureArea& area,
                     const Estimator& s) {
    gpu::Frame f{};
    f.cameraPosition = camera.position;
    f.cameraRight = camera.halfWidth * camera.right;
    f.cameraUp = camera.halfHeight * camera.up;
    f.cameraBack = camera.backOfMiddle();
    f.lensRadius = float(camera.lensRadius);
    f.focusDistance = float(camera.focusDistance);
    f.nearDistance = float(camera.nearDistance);
    f.farDistance = float(std::min(camera.farDistance, double(std::numeric_limits<float>::max())));
    f.width = area.width;
    f.height = area.height;
    f.seed = s.seed;
    f.minBounce = s.minBounce;
    f.maxBounces = s.maxBounces;
    f.terminationProbability = float(s.roulette.terminationProbability);
    f.lightCount = scene.lights.entries;
    f.areaLights = scene.lights.areaCount;
    f.ambientLight = scene.lights.ambientNumber;
    f.lightsInGroup0 = scene.lights.lightsInGroup[0];
    f.lightsInGroup1 = scene.lights.lightsInGroup[1];
    f.lightsInGroup2 = scene.lights.lightsInGroup[2];
    const DirectSampling direct = directSampling(scene.lights, s);
    f.hemisphereSamples = direct.hemisphere;
    f.lightSamples = direct.lights;
    f.branches = s.branches;
    f.gapWidth = scene.gapWidth;
    f.portalShare = float(scene.portals.share);
    f.litCells = scene.lit ? uint32_t(scene.lit->cells.size()) : 0;
    f.leastFall = leastFall(scene.occluders);
    std::ranges::copy(occluderRows(scene.occluders), std::begin(f.occluders));
    std::ranges::copy(portalRows(scene.portals.all), std::begin(f.portals));
    if (scene.shadowMap) {
        f.shadowAcross = scene.shadowMap->across;
        f.shadowAlong = scene.shadowMap->along;
        f.shadowTowards = scene.shadowMap->towards;
    }
    f.cameraMedium =
        camera.medium == kNoMedium ? gpu::NO_MEDIUM : scene.mediumRow.at(camera.medium);
    return f;
}

// --- What the camera sees ------------------------------------------------------------------------

namespace {

/// A pixel in the film of a kernel that sees.
struct SeenState {
    gpu::PixelState state;
    gpu::SeenPixel seen;
};
static_assert(sizeof(SeenState) == 16 * (gpu::PIXEL_STATE_ROWS + gpu::SEEN_ROWS));

/// In the scene's terms.
SeenPixel seenPixelOf(const SeenState& pixel, Seeing what, const GpuScene& scene) {
    const gpu::SeenPixel& s = pixel.seen;
    SeenPixel seen;
    seen.samples = pixel.state.count;
    seen.hits = s.hits;
    seen.covered = s.covered;
#define TAKE_SUM(name, value, otherwise) seen.name = glm::vec3(s.name);
    SEEN_SUMS(TAKE_SUM)
#undef TAKE_SUM
    if (what == Seeing::Coverage || s.hits == 0) return seen;
    seen.primitive = scene.bvh.primitiveOrder[s.primitive];
    seen.placement = s.placement;
    std::array<double, 3> weights{};
    const std::array<double, 3> ofSlot = {1 - double(s.b1) - s.b2, s.b1, s.b2};
    for (size_t c = 0; c < 3; ++c)
        weights[(c + scene.bvh.firstCorner[seen.primitive]) % 3] = ofSlot[c];
    seen.b1 = weights[1];
    seen.b2 = weights[2];
    return seen;
}

} // namespace

// --- The backend ---------------------------------------------------------------------------------

namespace {

/// By what samples choose where they go: light samples to the sky by the guide, bounces by lit
/// cells, of which there are none where there is a sky. Empty: by neither.
std::vector<Row> whereSamplesGo(const GpuScene& scene, const Estimator& estimator) {
    if (aimsBounces(scene, estimator)) return litRows(*scene.lit);
    if (guidesLight(scene, estimator)) return scene.guide->rows;
    return {};
}

} // namespace

DeviceTuning tuningFor(const KernelTuning& tuning, const vulkan::Device& device,
                       const GpuScene& scene, const PictureArea& area, uint32_t strands) {
    const uint64_t pixels = area.pixelCount(), whole = uint64_t(area.width) * area.height;
    const uint64_t items = pixels * std::max(strands, 1u);
    DeviceTuning resolved = resolve(tuning, device, largestRowBuffer(scene, items));
    resolved.strands = strands > 0 ? strands : strandsThatSuit(resolved, whole);
    return forPixels(resolved, pixels);
}

VulkanBackend::VulkanBackend(const vulkan::Device& device, const GpuScene& scene,
                             const Camera& camera, const RenderSettings& settings,
                             const KernelTuning& tuning)
    : device_(device), scene_(&scene), tuning_(tuning) {
    setPicture(camera, settings);
}

void VulkanBackend::setScene(const GpuScene& scene) {
    dispatcher_.reset(); // before the memory of the next is asked for
    film_.reset();
    filled_.clear();
    if (deviceScene_) filled_ = deviceScene_->releaseWhatIsAlsoIn(scene);
    deviceScene_.reset();
    scene_ = &scene;
}

void VulkanBackend::sceneHasChanged(std::span<const uint32_t> bindings) {
    dispatcher_.reset();
    film_.reset();
    if (deviceScene_) filled_ = deviceScene_->releaseAllBut(bindings);
    deviceScene_.reset();
}

void VulkanBackend::setPicture(const Camera& camera, const RenderSettings& settings) {
    const Estimator& estimator = settings.estimator;
    const DeviceTuning tuning =
        tuningFor(tuning_, device_, *scene_, settings.area, settings.strands);
    dispatcher_.reset(); // before the memory of the next is asked for
    film_.reset();
    checkMemory(device_.description(), *scene_, settings.area, estimator, tuning);
    if (kernelsFetchTexels_ != tuning.texelFetch) {
        kernels_.clear(); // where a picture's work list is too large for the device's texel buffers
        deviceScene_.reset();
    }
    kernelsFetchTexels_ = tuning.texelFetch;
    area_ = settings.area;
    camera_ = camera;
    estimator_ = estimator;
    frame_ = makeFrame(*scene_, camera, area_, estimator);
    // The driver compiles on one thread, and the scene goes to the device meanwhile.
    std::future<StageKernels> compiled = std::async(std::launch::async, [&] {
        return kernelsFor(kernelFeatures(*scene_, camera, estimator, tuning), tuning);
    });
    if (!deviceScene_)
        deviceScene_ =
            std::make_unique<DeviceScene>(device_, *scene_, tuning, std::exchange(filled_, {}));
    filter_ =
        uploaded("pixel filter", filterTable(estimator.filter, estimator.filterShape), tuning);
    std::vector<Row> rows = whereSamplesGo(*scene_, estimator);
    frame_.shadowMap = uint32_t(rows.size());
    if (looksAtShadowMap(*scene_, estimator) && scene_->shadowMap)
        std::ranges::copy(scene_->shadowMap->heights, std::back_inserter(rows));
    guide_ = rows.empty() ? nullptr : uploaded("where samples go", rows, tuning);
    const StageKernels kernels = compiled.get();
    kernel_ = kernels.front();
    film_ = std::make_unique<DeviceFilm>(device_, area_, tuning);
    dispatcher_ = makeDispatcher(film_->segments(), kernels, frame_, tuning);
}

std::unique_ptr<Dispatcher> VulkanBackend::makeDispatcher(std::span<const FilmSegment> film,
                                                          const StageKernels& kernels,
                                                          const gpu::Frame& frame,
                                                          const DeviceTuning& tuning) const {
    const DispatchTarget target{device_, *deviceScene_, film, *filter_,
                                guide_ ? *guide_ : *filter_};
    const DispatchSettings settings{frame, tuning, tuning_.targetSeconds, tuning_.fixedIterations};
    if (tuning.scheduler == PathScheduler::Wavefront)
        return std::make_unique<WavefrontDispatcher>(target, kernels, settings);
    return std::make_unique<PersistentDispatcher>(target, *kernels.front(), settings);
}

std::unique_ptr<vulkan::Buffer> VulkanBackend::uploaded(std::string_view name,
                                                        const std::vector<Row>& rows,
                                                        const DeviceTuning& tuning) const {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(rows));
    auto buffer =
        std::make_unique<vulkan::Buffer>(device_, std::string(name), bytes.size(), rowUse(tuning));
    vulkan::Queue queue(device_);
    buffer->upload(queue, bytes);
    return buffer;
}

StageKernels VulkanBackend::kernelsFor(const KernelFeatures& features, const DeviceTuning& tuning) {
    StageKernels kernels{};
    if (tuning.scheduler == PathScheduler::Persistent)
        kernels.front() = &kernelFor(features, tuning, {});
    else
        for (uint32_t stage = 0; stage < kernels.size(); ++stage)
            kernels[stage] = &kernelFor(features, tuning, stage);
    return kernels;
}

const PathKernel& VulkanBackend::kernelFor(const KernelFeatures& features,
                                           const DeviceTuning& tuning,
                                           std::optional<uint32_t> stage) {
    const std::pair key(features, stage);
    const auto known = kernels_.find(key);
    if (known != kernels_.end()) return known->second;
    return kernels_
        .try_emplace(key, device_, features, tuning.texelFetch, tuning_.specialiser, stage)
        .first->second;
}

/// A picture of its own, with the kernel that sees and a film of these pixels.
std::vector<SeenPixel> VulkanBackend::see(uint32_t first, std::span<const uint32_t> samples,
                                          Seeing what, uint32_t firstSample) {
    const uint64_t pixels = samples.size();
    const DeviceTuning tuning =
        forPixels(tuningFor(tuning_, device_, *scene_, area_), std::max<uint64_t>(pixels, 1));
    gpu::Frame frame = frame_;
    frame.firstSample = firstSample;
    frame.hemisphereSamples = frame.lightSamples = 0; // which number the blocks of random numbers
    vulkan::Queue queue(device_);
    FilmSegment film{first, uint32_t(pixels),
                     vulkan::Buffer(device_, "layers", pixels * sizeof(SeenState), rowUse(tuning))};
    film.pixels.clear(queue);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < pixels; ++i)
        if (samples[i] > 0) targets.push_back({first + i, samples[i]});
    std::vector<gpu::WorkItem> work;
    for (const PixelTarget& t : tileOrder(targets, area_.rendered().width)) {
        const PixelPlace place = area_.placeOf(t.pixel);
        work.push_back({t.pixel - first, t.samples, place.x, place.y});
    }
    makeDispatcher({&film, 1},
                   kernelsFor(seeingFeatures(*scene_, camera_, estimator_, tuning, what), tuning),
                   frame, tuning)
        ->run(0, work, [](uint64_t) { return true; });
    std::vector<SeenState> states(pixels);
    film.pixels.download(queue, std::as_writable_bytes(std::span(states)));
    std::vector<SeenPixel> seen;
    seen.reserve(pixels);
    for (const SeenState& s : states)
        seen.push_back(seenPixelOf(s, what, *scene_));
    return seen;
}

void VulkanBackend::sample(std::span<const PixelTarget> targets, Film& film,
                           const PassProgress& progress) {
    const std::vector<std::vector<gpu::WorkItem>> work =
        film_->workOf(tileOrder(targets, area_.rendered().width));
    uint64_t done = 0;
    const auto advance = [&](uint64_t samples) {
        done += samples;
        return !progress || progress(done);
    };
    bool goesOn = true;
    for (size_t segment = 0; segment < work.size() && goesOn; ++segment) {
        goesOn = dispatcher_->run(segment, work[segment], advance);
        film_->readBack(segment, work[segment], film);
    }
}

/// Takes the sample with frame constants and a pixel state of its own; what was there is put back
/// at the end.
SampleValue VulkanBackend::sampleAlone(uint32_t pixel, uint32_t sample) {
    const auto [segment, index] = film_->firstStrandOf(pixel);
    const PixelPlace place = area_.placeOf(pixel);
    const gpu::WorkItem item = {index, 1, place.x, place.y};
    gpu::Frame frame = frame_;
    frame.firstSample = sample;
    frame.keepsValue = 1;
    dispatcher_->setFrame(frame);
    const gpu::PixelState before = film_->read(segment, index);
    film_->write(segment, index, gpu::PixelState{});
    dispatcher_->run(segment, std::span(&item, 1), [](uint64_t) { return true; });
    const gpu::PixelState state = film_->read(segment, index);
    film_->write(segment, index, before);
    dispatcher_->setFrame(frame_);
    return {state.sum, state.rejected > 0};
}

/// A film of its own, with a state for each sample: all are of the picture's pixel, strand by
/// strand, and each has as many samples behind it as to take the next with its number.
std::vector<SampleValue> VulkanBackend::someAlone(uint32_t pixel, uint32_t first,
                                                  uint32_t count) const {
    const PixelPlace place = area_.placeOf(pixel);
    const DeviceTuning tuning = forPixels(tuningFor(tuning_, device_, *scene_, area_), count);
    std::vector<gpu::PixelState> states(count);
    std::vector<gpu::WorkItem> work;
    for (uint32_t i = 0; i < count; ++i) {
        states[i].count = i / strands();
        work.push_back({i, states[i].count + 1, place.x, place.y});
    }
    gpu::Frame frame = frame_;
    frame.firstSample = first;
    frame.keepsValue = 1;
    vulkan::Queue queue(device_);
    FilmSegment film{
        pixel, count,
        vulkan::Buffer(device_, "samples", count * sizeof(gpu::PixelState), rowUse(tuning))};
    film.pixels.upload(queue, std::as_bytes(std::span(states)));
    StageKernels kernels{};
    kernels.front() = kernel_;
    DeviceTuning persistent = tuning;
    persistent.scheduler = PathScheduler::Persistent;
    makeDispatcher({&film, 1}, kernels, frame, persistent)->run(0, work, [](uint64_t) {
        return true;
    });
    film.pixels.download(queue, std::as_writable_bytes(std::span(states)));
    std::vector<SampleValue> values;
    values.reserve(count);
    for (const gpu::PixelState& state : states)
        values.push_back({state.sum, state.rejected > 0});
    return values;
}

std::vector<SampleValue> VulkanBackend::samplesAlone(uint32_t pixel, uint32_t first,
                                                     uint32_t count) {
    if (tuning_.scheduler == PathScheduler::Wavefront)
        return Backend::samplesAlone(pixel, first, count);
    constexpr uint32_t kAtOnce = 1u << 16;
    std::vector<SampleValue> values;
    for (uint32_t done = 0; done < count; done += kAtOnce)
        for (const SampleValue& value :
             someAlone(pixel, first + done, std::min(kAtOnce, count - done)))
            values.push_back(value);
    return values;
}

/// A film of one pixel, behind whose state the kernel that records writes. Both schedulers make the
/// same sample, and the one without queues records it.
RecordedPath VulkanBackend::record(uint32_t pixel, uint32_t sample) {
    if (estimator_.integrator != Integrator::Path)
        throw std::invalid_argument("only paths are recorded");
    const PixelPlace place = area_.placeOf(pixel);
    KernelTuning asked = tuning_;
    asked.scheduler = PathScheduler::Persistent;
    const DeviceTuning tuning = forPixels(tuningFor(asked, device_, *scene_, area_), 1);
    const gpu::WorkItem item = {0, 1, place.x, place.y};
    gpu::Frame frame = frame_;
    frame.firstSample = sample;
    frame.keepsValue = 1;
    struct Recording {
        gpu::PixelState state;
        uint32_t count, unused[3];
        std::array<gpu::PathEvent, gpu::MOST_EVENTS> events;
    };
    auto recording = std::make_unique<Recording>();
    vulkan::Queue queue(device_);
    FilmSegment film{pixel, 1,
                     vulkan::Buffer(device_, "recording", sizeof(Recording), rowUse(tuning))};
    film.pixels.clear(queue);
    makeDispatcher({&film, 1},
                   kernelsFor(recordingFeatures(*scene_, camera_, estimator_, tuning), tuning),
                   frame, tuning)
        ->run(0, std::span(&item, 1), [](uint64_t) { return true; });
    film.pixels.download(queue, std::as_writable_bytes(std::span(recording.get(), 1)));
    RecordedPath path =
        recordedPath(recording->events, recording->count, estimator_.branches, *scene_);
    path.radiance = recording->state.sum;
    path.rejected = recording->state.rejected > 0;
    return path;
}

void VulkanBackend::beginAt(uint32_t firstSample) {
    film_->clear();
    frame_.firstSample = firstSample;
    dispatcher_->setFrame(frame_);
}

KeptPixels VulkanBackend::save(const Film&, PixelRun run) {
    return film_->save(run);
}

void VulkanBackend::restore(PixelRun run, const KeptPixels& pixels, Film& film) {
    film_->restore(run, pixels, film);
}

} // namespace stromboli
