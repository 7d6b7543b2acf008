#include "host/kernel/vulkan_backend.hpp"

#include "embedded/see_storage.h"
#include "embedded/see_texel.h"
#include "host/core/error.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "shaders/shared/medium_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <future>
#include <limits>
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
    f.lightCount = scene.lights.count;
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
    f.cameraMedium =
        camera.medium == kNoMedium ? gpu::NO_MEDIUM : scene.mediumRow.at(camera.medium);
    return f;
}

// --- Camera rays without light -------------------------------------------------------------------

namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

constexpr double kTargetSeconds = 0.1; ///< of a dispatch, as KernelTuning has it

/// One iteration of the loop counts for itself, its traversal steps and pixel filter, and the loose
/// textures of a material.
uint32_t hardLimit(const vulkan::Device& device, const GpuScene& scene,
                   std::span<const uint32_t> constants) {
    return loopLimit(device, 1 + passesOfCameraRays(constants) + (scene.mostTextures + 1));
}

std::vector<vulkan::Binding> bindings(bool texelFetch) {
    std::vector<vulkan::Binding> all;
    for (uint32_t i = 0; i < SCENE_BINDING_COUNT; ++i)
        all.push_back({i, texelFetch ? BufferUse::Texel : BufferUse::Storage});
    all.push_back({BINDING_FRAME, BufferUse::Uniform});
    all.push_back({BINDING_FILTER, texelFetch ? BufferUse::Texel : BufferUse::Storage});
    all.push_back({BINDING_SEEN_PIXELS, BufferUse::Storage});
    all.push_back({BINDING_SEEN_STATUS, BufferUse::Storage});
    return all;
}

std::vector<const Buffer*> buffersOf(const DeviceScene& scene,
                                     std::initializer_list<const Buffer*> more) {
    std::vector<const Buffer*> buffers;
    for (const Buffer& b : scene.buffers())
        buffers.push_back(&b);
    buffers.insert(buffers.end(), more);
    return buffers;
}

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

} // namespace

std::vector<uint32_t> seeConstants(const GpuScene& scene, const Camera& camera,
                                   const Estimator& settings, const DeviceTuning& tuning,
                                   Seeing what) {
    Estimator estimator = settings;
    // That of normals asks for what is there, and for no material.
    estimator.integrator = what == Seeing::Coverage ? Integrator::Normals : Integrator::Path;
    const KernelFeatures f = kernelFeatures(scene, camera, estimator, tuning);
    std::vector<uint32_t> constants(f.begin(), f.end());
    constants.push_back(what == Seeing::Surfaces);
    return constants;
}

vulkan::ComputePipeline makeSeePipeline(const vulkan::Device& device,
                                        const std::vector<uint32_t>& constants,
                                        const DeviceTuning& tuning) {
    const std::span<const uint32_t> code =
        tuning.texelFetch ? std::span<const uint32_t>(see_texel) : see_storage;
    return {device, code, bindings(tuning.texelFetch), constants, sizeof(gpu::SeeDispatch)};
}

SeePass::SeePass(const vulkan::Device& device, const DeviceScene& scene,
                 const vulkan::ComputePipeline& pipeline, std::span<const uint32_t> constants,
                 const vulkan::Buffer& filter, const gpu::Frame& frame, const DeviceTuning& tuning,
                 uint32_t pixels)
    : device_(device), pipeline_(pipeline), tuning_(tuning), pixelCount_(pixels),
      hardIterations_(hardLimit(device, scene.scene(), constants)), queue_(device),
      frame_(device, "frame constants", sizeof(gpu::Frame), BufferUse::Uniform),
      pixels_(device, "layers", pixels * sizeof(gpu::SeenPixel), BufferUse::Storage),
      status_(device, "status of the layers", sizeof(gpu::SeeStatus), BufferUse::Storage),
      set_(device, pipeline, buffersOf(scene, {&frame_, &filter, &pixels_, &status_})) {
    frame_.upload(queue_, bytesOf(frame));
}

gpu::SeeStatus SeePass::dispatch(uint32_t softIterations) {
    const gpu::SeeDispatch constants{pixelCount_, softIterations, hardIterations_};
    gpu::SeeStatus status{};
    status_.upload(queue_, bytesOf(status));
    const uint32_t groups = (pixelCount_ + tuning_.workgroupSize - 1) / tuning_.workgroupSize;
    seconds_ = queue_.run("look at the scene", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device_, commands, pipeline_, set_, bytesOf(constants), groups);
    });
    status_.download(queue_, std::as_writable_bytes(std::span(&status, 1)));
    return status;
}

void SeePass::run(std::vector<gpu::SeenPixel>& pixels) {
    pixels_.upload(queue_, std::as_bytes(std::span(pixels)));
    DispatchPace pace(kTargetSeconds, std::max(hardIterations_ / 2, 1u));
    gpu::SeeStatus status{};
    do {
        status = dispatch(pace.iterations());
        pace.took(seconds_);
        if (status.overflowedPixels > 0)
            throw DeviceError(fmt::format(
                "the camera rays of {} pixels needed more than {} loop iterations, the most that "
                "{} runs in a dispatch, to get to the next surface",
                status.overflowedPixels, hardIterations_, device_.description().name()));
    } while (status.unfinishedPixels > 0);
    pixels_.download(queue_, std::as_writable_bytes(std::span(pixels)));
}

SeenPixel seenPixelOf(const gpu::SeenPixel& pixel, const GpuScene& scene) {
    SeenPixel seen;
    seen.samples = pixel.samples;
    seen.hits = pixel.hits;
    seen.covered = pixel.covered;
#define TAKE_SUM(name, value) seen.name = glm::vec3(pixel.name);
    SEEN_SUMS(TAKE_SUM)
#undef TAKE_SUM
    if (pixel.primitive == kNothingSeen) return seen;
    seen.primitive = scene.bvh.primitiveOrder[pixel.primitive];
    seen.placement = pixel.placement;
    std::array<double, 3> weights{};
    const std::array<double, 3> ofSlot = {1 - double(pixel.b1) - pixel.b2, pixel.b1, pixel.b2};
    for (size_t c = 0; c < 3; ++c)
        weights[(c + scene.bvh.firstCorner[seen.primitive]) % 3] = ofSlot[c];
    seen.b1 = weights[1];
    seen.b2 = weights[2];
    return seen;
}

// --- The backend ---------------------------------------------------------------------------------

namespace {

/// No more lanes or items than there are pixels.
DeviceTuning tuningFor(const KernelTuning& tuning, const vulkan::Device& device,
                       const GpuScene& scene, const PictureArea& area) {
    DeviceTuning t = resolve(tuning, device, largestRowBuffer(scene, area.pixelCount()));
    t.lanes = uint32_t(std::min<uint64_t>(t.lanes, area.pixelCount()));
    t.itemsPerDispatch = uint32_t(std::min<uint64_t>(t.itemsPerDispatch, area.pixelCount()));
    return t;
}

} // namespace

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
    const DeviceTuning tuning = tuningFor(tuning_, device_, *scene_, settings.area);
    dispatcher_.reset(); // before the memory of the next is asked for
    film_.reset();
    checkMemory(device_.description(), *scene_, settings.area, estimator, tuning);
    if (kernelsFetchTexels_ != tuning.texelFetch) {
        seePipelines_.clear();
        kernels_.clear(); // where a picture's work list is too large for the device's texel buffers
        deviceScene_.reset();
    }
    kernelsFetchTexels_ = tuning.texelFetch;
    // The driver compiles on one thread, and the scene goes to the device meanwhile.
    const KernelFeatures features = kernelFeatures(*scene_, camera, estimator, tuning);
    std::future<StageKernels> compiled =
        std::async(std::launch::async, [&] { return kernelsFor(features, tuning); });
    if (!deviceScene_)
        deviceScene_ =
            std::make_unique<DeviceScene>(device_, *scene_, tuning, std::exchange(filled_, {}));
    area_ = settings.area;
    camera_ = camera;
    estimator_ = estimator;
    frame_ = makeFrame(*scene_, camera, area_, estimator);
    const StageKernels kernels = compiled.get();
    kernel_ = kernels.front();
    film_ = std::make_unique<DeviceFilm>(device_, area_, tuning);
    setFilter(filterTable(estimator.filter, estimator.filterShape), tuning);
    dispatcher_ = makeDispatcher(kernels, tuning);
}

std::unique_ptr<Dispatcher> VulkanBackend::makeDispatcher(const StageKernels& kernels,
                                                          const DeviceTuning& tuning) const {
    const DispatchTarget target{device_, *deviceScene_, *film_, *filter_};
    const DispatchSettings settings{frame_, tuning, tuning_.targetSeconds, tuning_.fixedIterations};
    if (tuning.scheduler == PathScheduler::Wavefront)
        return std::make_unique<WavefrontDispatcher>(target, kernels, settings);
    return std::make_unique<PersistentDispatcher>(target, *kernels.front(), settings);
}

void VulkanBackend::setFilter(const std::vector<Row>& table, const DeviceTuning& tuning) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(table));
    filter_ =
        std::make_unique<vulkan::Buffer>(device_, "pixel filter", bytes.size(), rowUse(tuning));
    vulkan::Queue queue(device_);
    filter_->upload(queue, bytes);
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

const vulkan::ComputePipeline& VulkanBackend::seePipelineFor(const std::vector<uint32_t>& constants,
                                                             const DeviceTuning& tuning) {
    const auto known = seePipelines_.find(constants);
    if (known != seePipelines_.end()) return known->second;
    return seePipelines_.emplace(constants, makeSeePipeline(device_, constants, tuning))
        .first->second;
}

std::vector<SeenPixel> VulkanBackend::see(uint32_t first, std::span<const uint32_t> samples,
                                          Seeing what, uint32_t firstSample) {
    gpu::Frame frame = frame_;
    frame.firstSample = firstSample;
    std::vector<gpu::SeenPixel> pixels(samples.size());
    for (uint32_t i = 0; i < pixels.size(); ++i) {
        const PixelPlace place = area_.placeOf(first + i);
        pixels[i].target = samples[i];
        pixels[i].pixel = place.y * area_.width + place.x;
        pixels[i].primitive = kNothingSeen;
    }
    const DeviceTuning tuning = tuningFor(tuning_, device_, *scene_, area_);
    const auto constants = seeConstants(*scene_, camera_, estimator_, tuning, what);
    SeePass(device_, *deviceScene_, seePipelineFor(constants, tuning), constants, *filter_, frame,
            tuning, uint32_t(pixels.size()))
        .run(pixels);
    std::vector<SeenPixel> seen;
    seen.reserve(pixels.size());
    for (const gpu::SeenPixel& p : pixels)
        seen.push_back(seenPixelOf(p, *scene_));
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
    const auto [segment, index] = film_->segmentOf(pixel);
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

void VulkanBackend::beginAt(uint32_t firstSample) {
    film_->clear();
    frame_.firstSample = firstSample;
    dispatcher_->setFrame(frame_);
}

std::vector<PixelSums> VulkanBackend::save(const Film&, PixelRun run) {
    return film_->save(run);
}

void VulkanBackend::restore(PixelRun run, std::span<const PixelSums> sums, Film& film) {
    film_->restore(run, sums, film);
}

} // namespace stromboli
