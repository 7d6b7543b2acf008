#pragma once

#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/dispatcher.hpp"

namespace stromboli {

/// The persistent scheduler (shaders/pathtrace.comp): a submission is one dispatch, in which each
/// lane follows paths until enough iterations of its loop are done.
class PersistentDispatcher final : public Dispatcher {
  public:
    PersistentDispatcher(const DispatchTarget& target, const PathKernel& kernel,
                         const DispatchSettings& settings);

  private:
    void record(VkCommandBuffer commands, const Share& share) override;
    void hasRun(double seconds, gpu::DispatchStatus& status) override;

    const PathKernel& kernel_;
    uint32_t softIterations_;
    DispatchPace pace_;
};

} // namespace stromboli
