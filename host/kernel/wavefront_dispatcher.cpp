#include "host/kernel/wavefront_dispatcher.hpp"

namespace stromboli {
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
