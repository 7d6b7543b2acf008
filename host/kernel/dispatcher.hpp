#pragma once

#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/kernel/path_kernel.hpp"
#include "host/render/backend.hpp"
#include "shaders/shared/wavefront_types.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- The order of work ---------------------------------------------------------------------------

/// Puts targets (in row order) into the order in which lanes take them: tile by tile of 8 x 8
/// pixels, so that the rays of lanes that work side by side are alike. Pixels that need no more
/// samples are not in the list, and lanes take the next item whenever they are done with one, so
/// the order need not balance anything.
std::vector<PixelTarget> tileOrder(std::span<const PixelTarget> targets, uint32_t width);

// --- Dispatches ----------------------------------------------------------------------------------

/// How well traversal filled the lanes.
struct StepCounters {
    uint64_t busy = 0; ///< traversal steps of lanes that had a ray under way ...
    uint64_t all = 0;  ///< ... out of these
};

/// Loop passes that one iteration of the kernel's loop may run, for devices that end loops by their
/// number (loopLimit()). One iteration counts for itself, its traversal steps and pixel filter, the
/// loop around it that changes pixels and, where there are such, the walk down the light tree, the
/// loose textures of a material, the materials of a mixture, the steps through a grid of densities,
/// the walks down the tree of guided light samples, the portals and near lamps that are chosen
/// from, and the occluders.
uint32_t loopPasses(const GpuScene& scene, const KernelFeatures& features);

/// What a dispatcher works on. All must outlive it.
struct DispatchTarget {
    const vulkan::Device& device;
    const DeviceScene& scene;
    std::span<const FilmSegment> film;
    const vulkan::Buffer& filter; ///< the picture's table (sampling_tables.hpp)
    const vulkan::Buffer& guide;  ///< what guides samples, and the shadow map; any other without
};

/// How it does so.
struct DispatchSettings {
    gpu::Frame frame;
    DeviceTuning tuning;
    double targetSeconds;                    ///< of a submission
    std::optional<uint32_t> fixedIterations; ///< of each submission, instead of pacing (tests)
};

/// Runs the path kernel over work lists in submissions that are neither too long nor too short, and
/// keeps what lanes have in hand between them. Each scheduler is a class of its own.
class Dispatcher {
  public:
    /// kernel: any of the scheduler's, for its features and the layout of its bindings.
    Dispatcher(const DispatchTarget& target, const PathKernel& kernel,
               const DispatchSettings& settings);
    virtual ~Dispatcher() = default;
    Dispatcher(const Dispatcher&) = delete;
    Dispatcher& operator=(const Dispatcher&) = delete;

    /// Dispatches until every item of the work list has its samples. `advance` is told how many
    /// samples each dispatch took; if it returns false, no further sample is begun, those under way
    /// are ended without bias (shaders/include/path_kernel.glsl, endsSampleUnderWay), and the
    /// result is false. Throws DeviceError if a surface needs more loop iterations than the device
    /// runs.
    bool run(size_t segment, std::span<const gpu::WorkItem> items,
             const std::function<bool(uint64_t)>& advance);

    void setFrame(const gpu::Frame& frame);

    RenderCounters counters() const { return counters_; }
    StepCounters steps() const { return steps_; }
    /// Seconds by the device's clock in all dispatches so far.
    double kernelSeconds() const { return kernelSeconds_; }

  protected:
    /// A submission's part of a work list.
    struct Share {
        size_t segment = 0;
        uint32_t itemCount = 0;
        bool isFirst = false;  ///< of this list
        bool ends = false;     ///< no sample is to be begun
        bool isEnding = false; ///< ends, and the submission before it did not
    };
    /// Records one submission.
    virtual void record(VkCommandBuffer commands, const Share& share) = 0;
    /// After it: `status` as the kernel left it. Sets its unfinishedItems, if the kernel does not.
    virtual void hasRun(double seconds, gpu::DispatchStatus& status) = 0;

    gpu::Dispatch constants(const Share& share) const;
    std::optional<uint32_t> fixedIterations() const { return fixedIterations_; }

    const vulkan::Device& device_;
    DeviceTuning tuning_;
    uint32_t hardIterations_;
    vulkan::Queue queue_;
    vulkan::Buffer paths_; ///< PathBuffers
    std::optional<vulkan::Buffer> queues_;
    std::vector<std::unique_ptr<vulkan::DescriptorSet>> sets_; ///< of each segment of the film

  private:
    bool runChunk(size_t segment, std::span<const gpu::WorkItem> items,
                  const std::function<bool(uint64_t)>& advance);
    void dispatch(const Share& share, gpu::DispatchStatus& status);
    void count(const gpu::DispatchStatus& status);

    std::span<const FilmSegment> film_;
    std::optional<uint32_t> fixedIterations_;
    vulkan::Buffer frameBuffer_, workItems_, status_;
    RenderCounters counters_;
    StepCounters steps_;
    double kernelSeconds_ = 0;
};

// --- The persistent scheduler --------------------------------------------------------------------

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

// --- The wavefront scheduler ---------------------------------------------------------------------

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
