#include "host/kernel/dispatcher.hpp"

#include "host/core/error.hpp"
#include "shaders/shared/guide_types.h"
#include "shaders/shared/medium_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace stromboli {

// --- The order of work ---------------------------------------------------------------------------

std::vector<PixelTarget> tileOrder(std::span<const PixelTarget> targets, uint32_t width) {
    if (targets.empty()) return {};
    constexpr uint32_t kTile = 8; // pixels: one row of a tile fills the lanes of an AVX2 register
    const size_t tilesAcross = (width + kTile - 1) / kTile;
    const auto tileOf = [&](const PixelTarget& t) {
        return t.pixel / width / kTile * tilesAcross + t.pixel % width / kTile;
    };
    // Counting sort: targets are in row order, and so are those of a tile.
    std::vector<size_t> firstOf(tileOf(targets.back()) / tilesAcross * tilesAcross + tilesAcross +
                                1);
    for (const PixelTarget& t : targets)
        ++firstOf[tileOf(t) + 1];
    std::partial_sum(firstOf.begin(), firstOf.end(), firstOf.begin());
    std::vector<PixelTarget> order(targets.size());
    for (const PixelTarget& t : targets)
        order[firstOf[tileOf(t)]++] = t;
    return order;
}

// --- Dispatches ----------------------------------------------------------------------------------

uint32_t loopPasses(const GpuScene& scene, const KernelFeatures& features) {
    // At a hit, where a path splits again, and at the end of a ray of hemisphere sampling.
    constexpr uint32_t kTextureLoops = 3;
    // At a hit to draw one, for a light sample and for a bounce to evaluate the others.
    const uint32_t textures = scene.mostTextures + 1, others = scene.mostOthers;
    const uint32_t mixtures = (scene.mostBlends ? scene.mostBlends + 1 : 0) +
                              (others ? 2 * (others + 1) * (1 + textures) : 0);
    // At a surface, at its other side for a light sample, and for a bounce.
    constexpr uint32_t kGuideLoops = 3;
    const bool isGuided = features[SPEC_GUIDES_LIGHT] != 0;
    // To choose one and to tell a sample's density, and that of a bounce that finds the sky.
    const uint32_t portals = features[SPEC_PORTALS];
    constexpr uint32_t kPortalLoops = 3;
    // To draw a distance about lamps, and to tell its density.
    const uint32_t foci = features[SPEC_FOCI];
    constexpr uint32_t kFociLoops = 2;
    // For a light sample to look at them.
    const uint32_t occluders = features[SPEC_OCCLUDERS];
    // A light is picked for a light sample, and looked up once more for MIS.
    return 1 + passesOfCameraRays(features) + 2 +
           (scene.lights.groups ? 2 * (scene.lights.levels + 1) : 0) +
           (scene.mostTextures ? kTextureLoops * textures : 0) + mixtures +
           (scene.media & gpu::MEDIA_VARY ? gpu::GRID_STEPS + 1 : 0) +
           (isGuided ? kGuideLoops * (gpu::GUIDE_LEVELS + 1) : 0) +
           (portals ? kPortalLoops * (portals + 1) : 0) + (foci ? kFociLoops * (foci + 1) : 0) +
           (occluders ? occluders + 1 : 0);
}

namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

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
      hardIterations_(loopLimit(device_, loopPasses(target.scene.scene(), kernel.features()))),
      queue_(device_), paths_(bufferOf(device_, pathBuffers(kernel, settings).paths)),
      film_(target.film), fixedIterations_(settings.fixedIterations),
      frameBuffer_(device_, "frame constants", sizeof(gpu::Frame), BufferUse::Uniform),
      workItems_(device_, "work list", tuning_.itemsPerDispatch * sizeof(gpu::WorkItem),
                 rowUse(tuning_)),
      status_(device_, "dispatch status", sizeof(gpu::DispatchStatus), BufferUse::Storage) {
    if (const auto queues = pathBuffers(kernel, settings).queues)
        queues_.emplace(bufferOf(device_, *queues));
    setFrame(settings.frame);
    for (const FilmSegment& s : target.film) {
        std::vector<const Buffer*> buffers;
        for (const Buffer& b : target.scene.buffers())
            buffers.push_back(&b);
        buffers.insert(buffers.end(), {&frameBuffer_, &workItems_, &s.pixels, &paths_, &status_,
                                       &target.filter, &target.guide});
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
                "runs in a dispatch: too many lights or light samples (-l) for one shading point",
                status.overflowedItems, hardIterations_, device_.description().name()));
        goesOn = advance(status.samples) && goesOn;
    } while (somethingIsLeft());
    return goesOn;
}

gpu::Dispatch Dispatcher::constants(const Share& share) const {
    gpu::Dispatch d{};
    d.itemCount = share.itemCount;
    d.segmentBase = film_[share.segment].firstPixel;
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

// --- The persistent scheduler --------------------------------------------------------------------

namespace {

/// Where lanes stop taking path rays. What is left has to do for one more surface with all its
/// direct light samples: a pass or more for each, and four times as much where they go through
/// glass (MOST_PANES).
uint32_t softLimit(uint32_t hard, const gpu::Frame& frame, const KernelFeatures& features) {
    const uint32_t rays = features[SPEC_LIGHT_THROUGH_GLASS] ? 4 : 1;
    const uint32_t directSamples = frame.hemisphereSamples + frame.lightSamples;
    return rays * directSamples < hard / 32 ? hard / 2 : 1;
}

/// Iterations a dispatch may be given. Where threads share them, a fast one runs more of them in a
/// group than the others: up to twice as many.
uint32_t paceLimit(uint32_t soft, const DeviceTuning& tuning) {
    return tuning.driverThreads > 0 ? std::max(soft / 2, 1u) : soft;
}

} // namespace

PersistentDispatcher::PersistentDispatcher(const DispatchTarget& target, const PathKernel& kernel,
                                           const DispatchSettings& settings)
    : Dispatcher(target, kernel, settings), kernel_(kernel),
      softIterations_(softLimit(hardIterations_, settings.frame, kernel.features())),
      pace_(settings.targetSeconds, paceLimit(softIterations_, settings.tuning)) {
    // No lane has an item, whatever its other words say.
    const std::vector<uint32_t> idle(
        tuning_.lanes * pathWords(kernel.features(), tuning_.scheduler), gpu::NO_ITEM);
    paths_.upload(queue_, std::as_bytes(std::span(idle)));
}

void PersistentDispatcher::record(VkCommandBuffer commands, const Share& share) {
    const uint32_t groups = (tuning_.lanes + tuning_.workgroupSize - 1) / tuning_.workgroupSize;
    gpu::Dispatch d = constants(share);
    if (tuning_.driverThreads == 0 || fixedIterations()) {
        d.softIterations = fixedIterations().value_or(pace_.iterations());
    } else {
        d.softIterations = softIterations_;
        d.groupsPerThread = std::max(groups / tuning_.driverThreads, 1u);
        d.sharedIterations = pace_.iterations() * tuning_.workgroupSize * tuning_.driverThreads;
    }
    vulkan::recordDispatch(device_, commands, kernel_.pipeline(), *sets_[share.segment],
                           std::as_bytes(std::span(&d, 1)), groups);
}

void PersistentDispatcher::hasRun(double seconds, gpu::DispatchStatus&) {
    pace_.took(seconds);
}

// --- The wavefront scheduler ---------------------------------------------------------------------

namespace {

/// Rounds of a submission: those in which nothing is left to do cost next to nothing, but are
/// recorded.
constexpr uint32_t kMostRounds = 1024;

uint64_t offsetOf(uint32_t queue) {
    return queue * sizeof(gpu::QueueHead);
}

} // namespace

WavefrontDispatcher::WavefrontDispatcher(const DispatchTarget& target, const StageKernels& kernels,
                                         const DispatchSettings& settings)
    : Dispatcher(target, *kernels.front(), settings), kernels_(kernels),
      pace_(settings.targetSeconds, kMostRounds) {
    paths_.clear(queue_);
    queues_->clear(queue_);
}

void WavefrontDispatcher::empty(VkCommandBuffer commands, uint32_t queue) {
    const gpu::QueueHead none{.groups = 0, .one = 1, .alsoOne = 1, .count = 0};
    device_.vk().vkCmdUpdateBuffer(commands, queues_->handle(), offsetOf(queue), sizeof(none),
                                   &none);
    vulkan::fullBarrier(device_, commands);
}

/// Begins or stops: puts every path into the queue that it belongs to.
void WavefrontDispatcher::enterAllPaths(VkCommandBuffer commands, const Share& share,
                                        uint32_t stage) {
    for (uint32_t queue = 0; queue < gpu::QUEUE_COUNT; ++queue)
        empty(commands, queue);
    rayQueue_ = gpu::QUEUE_RAYS;
    const gpu::Dispatch d = constants(share);
    const uint32_t groups = (tuning_.lanes + tuning_.workgroupSize - 1) / tuning_.workgroupSize;
    vulkan::recordDispatch(device_, commands, kernels_[stage]->pipeline(), *sets_[share.segment],
                           std::as_bytes(std::span(&d, 1)), groups);
}

void WavefrontDispatcher::serve(VkCommandBuffer commands, const Share& share, uint32_t stage,
                                uint32_t queue) {
    gpu::Dispatch d = constants(share);
    d.rayQueue = rayQueue_;
    vulkan::recordIndirectDispatch(device_, commands, kernels_[stage]->pipeline(),
                                   *sets_[share.segment], std::as_bytes(std::span(&d, 1)), *queues_,
                                   offsetOf(queue));
}

void WavefrontDispatcher::record(VkCommandBuffer commands, const Share& share) {
    if (share.isFirst)
        enterAllPaths(commands, share, gpu::STAGE_BEGIN);
    else if (share.isEnding)
        enterAllPaths(commands, share, gpu::STAGE_STOP);
    const uint32_t rounds = fixedIterations().value_or(pace_.iterations());
    for (uint32_t i = 0; i < rounds; ++i) {
        serve(commands, share, gpu::STAGE_DEPART, gpu::QUEUE_DEPARTING);
        empty(commands, gpu::QUEUE_DEPARTING);
        serve(commands, share, gpu::STAGE_TRACE, rayQueue_);
        serve(commands, share, gpu::STAGE_FOLLOW, rayQueue_);
        serve(commands, share, gpu::STAGE_LIGHT, gpu::QUEUE_LIT);
        empty(commands, gpu::QUEUE_LIT);
        empty(commands, rayQueue_);
        rayQueue_ = 2 * gpu::QUEUE_RAYS + 1 - rayQueue_;
    }
}

void WavefrontDispatcher::hasRun(double seconds, gpu::DispatchStatus& status) {
    pace_.took(seconds);
    std::array<gpu::QueueHead, gpu::QUEUE_COUNT> heads;
    queues_->download(queue_, std::as_writable_bytes(std::span(heads)));
    for (const gpu::QueueHead& head : heads)
        status.unfinishedItems += head.count;
}

} // namespace stromboli
