#include "host/kernel/persistent_dispatcher.hpp"

#include "host/kernel/path_words.hpp"

#include <algorithm>

namespace stromboli {
namespace {

/// Where lanes stop taking path rays. What is left has to do for one more surface with all its
/// direct light samples: a pass or more for each.
uint32_t softLimit(uint32_t hard, const gpu::Frame& frame) {
    const uint32_t directSamples = frame.hemisphereSamples + frame.lightSamples;
    return directSamples < hard / 32 ? hard / 2 : 1;
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
      softIterations_(softLimit(hardIterations_, settings.frame)),
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

} // namespace stromboli
