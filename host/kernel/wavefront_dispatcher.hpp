#pragma once

#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/dispatcher.hpp"
#include "shaders/shared/wavefront_types.h"

#include <array>

namespace stromboli {

/// The kernels of the wavefront scheduler, by STAGE_ number.
using StageKernels = std::array<const PathKernel*, gpu::STAGE_COUNT>;

/// The wavefront scheduler (shaders/wavefront.comp): a submission is a number of rounds, each of
/// which draws rays, traces them and takes them in, for all paths under way.
class WavefrontDispatcher final : public Dispatcher {
  public:
    /// The kernels must outlive the object. fixedIterations counts rounds.
    WavefrontDispatcher(const DispatchTarget& target, const StageKernels& kernels,
                        const DispatchSettings& settings);

  private:
    void record(VkCommandBuffer commands, const Share& share) override;
    void hasRun(double seconds, gpu::DispatchStatus& status) override;

    void empty(VkCommandBuffer commands, uint32_t queue);
    void enterAllPaths(VkCommandBuffer commands, const Share& share, uint32_t stage);
    void serve(VkCommandBuffer commands, const Share& share, uint32_t stage, uint32_t queue);

    StageKernels kernels_;
    DispatchPace pace_;                   ///< in rounds
    uint32_t rayQueue_ = gpu::QUEUE_RAYS; ///< of the next round
};

} // namespace stromboli
