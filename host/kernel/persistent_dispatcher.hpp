#pragma once

#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/dispatcher.hpp"

namespace stromboli {

/// The persistent scheduler (shaders/pathtrace.comp): a submission is one dispatch, in which each
/// lane follows paths until enough iterations of its loop are done.
class PersistentDispatcher final : public Dispatcher {
  public:
    /// As Dispatcher. targetSeconds: of a submission.
    PersistentDispatcher(const vulkan::Device& device, const DeviceScene& scene,
                         const PathKernel& kernel, DeviceFilm& film, const vulkan::Buffer& filter,
                         const gpu::Frame& frame, const DeviceTuning& tuning, double targetSeconds,
                         std::optional<uint32_t> fixedIterations);

  private:
    void record(VkCommandBuffer commands, const Share& share) override;
    void hasRun(double seconds, gpu::DispatchStatus& status) override;

    const PathKernel& kernel_;
    uint32_t softIterations_;
    DispatchPace pace_;
};

} // namespace stromboli
