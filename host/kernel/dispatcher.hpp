#pragma once

#include "host/kernel/device_film.hpp"
#include "host/kernel/device_scene.hpp"
#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/path_kernel.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace stromboli {

/// How well traversal filled the lanes.
struct StepCounters {
    uint64_t busy = 0; ///< traversal steps of lanes that had a ray under way ...
    uint64_t all = 0;  ///< ... out of these
};

/// Runs the kernel over work lists in dispatches that are neither too long nor too short, and keeps
/// what lanes have in hand between them.
class Dispatcher {
  public:
    /// All but `tuning` and `frame` must outlive the object. filter: the picture's table
    /// (filter_table.hpp). fixedIterations: of each dispatch, instead of pacing by time (tests).
    Dispatcher(const vulkan::Device& device, const DeviceScene& scene, const PathKernel& kernel,
               DeviceFilm& film, const vulkan::Buffer& filter, const gpu::Frame& frame,
               const DeviceTuning& tuning, double targetSeconds,
               std::optional<uint32_t> fixedIterations);

    /// Dispatches until every item of the work list has its samples. `advance` is told how many
    /// samples each dispatch took; if it returns false, no further sample is begun, those under way
    /// are ended without bias (shaders/pathtrace.comp, endsSampleUnderWay), and the result is
    /// false. Throws DeviceError if a surface needs more loop iterations than the device runs.
    bool run(size_t segment, std::span<const gpu::WorkItem> items,
             const std::function<bool(uint64_t)>& advance);

    void setFrame(const gpu::Frame& frame);

    RenderCounters counters() const { return counters_; }
    StepCounters steps() const { return steps_; }
    /// Seconds by the device's clock in all dispatches so far.
    double kernelSeconds() const { return kernelSeconds_; }

  private:
    bool runChunk(size_t segment, std::span<const gpu::WorkItem> items,
                  const std::function<bool(uint64_t)>& advance);
    gpu::Dispatch constants(size_t segment, uint32_t itemCount, uint32_t groups, bool ends) const;
    void dispatch(size_t segment, uint32_t itemCount, bool ends, gpu::DispatchStatus& status);
    void count(const gpu::DispatchStatus& status);

    const vulkan::Device& device_;
    const PathKernel& kernel_;
    DeviceFilm& film_;
    DeviceTuning tuning_;
    uint32_t hardIterations_, softIterations_;
    std::optional<uint32_t> fixedIterations_;
    DispatchPace pace_;
    vulkan::Queue queue_;
    vulkan::Buffer frameBuffer_, workItems_, suspended_, splits_, status_;
    std::vector<std::unique_ptr<vulkan::DescriptorSet>> sets_; ///< of each segment
    RenderCounters counters_;
    StepCounters steps_;
    double kernelSeconds_ = 0;
};

} // namespace stromboli
