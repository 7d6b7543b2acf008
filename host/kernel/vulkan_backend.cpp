#include "host/kernel/vulkan_backend.hpp"

#include "host/kernel/filter_table.hpp"
#include "host/kernel/frame.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/persistent_dispatcher.hpp"
#include "host/kernel/work_order.hpp"

#include <algorithm>
#include <future>
#include <utility>

namespace stromboli {
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

/// With a pixel state and frame constants of its own, which are put back at the end.
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
