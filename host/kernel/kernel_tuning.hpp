#pragma once

#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/device.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace stromboli {

// --- Tuning --------------------------------------------------------------------------------------

/// Who decides what each lane does next (docs/theory/kernel.md, "Two schedulers").
enum class PathScheduler {
    Persistent, ///< one kernel, whose lanes follow paths from ray to ray
    Wavefront,  ///< kernels that draw, trace and follow, with queues of paths between them
};

/// How the kernel runs; what is not given suits the device (resolve). None of it changes a picture,
/// but for lanesToFill the rounding of its sums.
struct KernelTuning {
    std::optional<bool> texelFetch; ///< read the scene through storage texel buffers
    std::optional<uint32_t> workgroupSize;
    std::optional<uint32_t> traversalSteps; ///< between two service passes, or in a leg
    std::optional<uint32_t> traversalLegs;  ///< where prototypes are placed
    std::optional<uint32_t> registerStack;  ///< largest traversal stack that is in registers
    std::optional<bool> stepsBranch;        ///< a traversal step leaves out what no lane needs
    std::optional<PathScheduler> scheduler;
    std::optional<uint32_t> lanes;       ///< invocations of a dispatch; wavefront: paths under way
    std::optional<uint32_t> lanesToFill; ///< that keep the device busy; 0: one at a pixel
    std::optional<uint32_t> driverThreads;    ///< 0: unknown
    std::optional<uint32_t> itemsPerDispatch; ///< pixels in a work list
    double targetSeconds = 0.1;               ///< of a dispatch
    std::optional<uint32_t> fixedIterations;  ///< instead of pacing by time (tests)
    bool countSteps = false;                  ///< count how many lanes are at work in each step
    bool everythingOn = false; ///< leave in all features, also those the scene lacks (benchmark)
    /// Who puts the constants into the kernel's module (tests compare the two).
    vulkan::Specialiser specialiser = vulkan::Specialiser::Ours;
};

/// How the kernel runs on a device: KernelTuning with nothing left open.
struct DeviceTuning {
    bool texelFetch = false;
    uint32_t workgroupSize = 64;
    uint32_t traversalSteps = 8;
    uint32_t richTraversalSteps = 8; ///< of kernels whose service is long (textures, layers)
    /// Between two services as many steps as a ray of the scene takes, where that is known, in
    /// place of these numbers.
    bool stepsFitRays = false;
    /// Where prototypes are placed, a ray is prepared anew for each leg between two service passes,
    /// and lanes that come to a placement or leave one wait for that.
    uint32_t placedTraversalSteps = 4, traversalLegs = 4;
    uint32_t registerStack = 0; ///< entries
    bool stepsBranch = false;   ///< a step of the traversal leaves out what no lane needs
    PathScheduler scheduler = PathScheduler::Persistent;
    uint32_t lanes = 1u << 20;
    uint32_t lanesToFill = 0;   ///< that keep the device busy; 0: one at a pixel
    uint32_t strands = 1;       ///< of a pixel (gpu::PixelState)
    uint32_t driverThreads = 0; ///< that run workgroups one after the other; 0: unknown, a GPU
    uint32_t itemsPerDispatch = 1u << 20;
    bool limitsLoops = false; ///< the device ends loops that take long (loopLimit())
    bool countSteps = false;
    bool everythingOn = false;
};

/// The rules, with their reasons, are in the source; docs/results.md has the measurements.
/// `rowBytes`: of the largest buffer that is read row by row; it decides whether the device's texel
/// buffers are large enough.
DeviceTuning resolve(const KernelTuning& tuning, const vulkan::Device& device,
                     uint64_t rowBytes = 0);

/// Whether rows are read through storage texel buffers on this device: where that is faster and
/// its limits allow it.
bool prefersTexels(const vulkan::DeviceDescription& device, uint64_t rowBytes);

// --- Limits of loops -----------------------------------------------------------------------------

/// Iterations that a kernel's main loop may run in one dispatch; `passes`: those of any loop that
/// one of its iterations can take. llvmpipe ends all loops of a group, silently, after 65,535
/// passes; on other devices it is only a guard against endless loops: a ray through 2^20 nodes is
/// none.
uint32_t loopLimit(const vulkan::Device& device, uint32_t passes);

/// Passes for the steps of the traversal and, where a sample begins, for the pixel filter's
/// inversion. constants: specialisation constants by their SPEC_ numbers.
uint32_t passesOfCameraRays(std::span<const uint32_t> constants);

// --- The pace of dispatches ----------------------------------------------------------------------

/// Chooses how long a dispatch runs: as a number of kernel loop iterations after which no lane
/// starts another ray. Learns from the time dispatches took, so that they stay near the target:
/// long enough to cost little, short enough for watchdogs and Ctrl-C.
///
/// The numbers are powers of two and the limit, so that they are few: they are push constants, and
/// lavapipe makes code of its own for each value of one that loops end by (Mesa 22.3, "inlined
/// uniforms"), which takes it tens of milliseconds for a large kernel.
class DispatchPace {
  public:
    /// limit: the most iterations a dispatch may ever be given.
    DispatchPace(double targetSeconds, uint32_t limit);
    uint32_t iterations() const { return iterations_; }
    void took(double seconds);

  private:
    double target_;
    uint32_t limit_;
    uint32_t iterations_;
};

/// Strands of each pixel that keep the device busy: a power of two. `pixels`: of the whole picture,
/// so that its parts have the bytes that they have in it.
uint32_t strandsThatSuit(const DeviceTuning& tuning, uint64_t pixels);

/// Has no more lanes and items of a work list than so many pixels have strands.
DeviceTuning forPixels(DeviceTuning tuning, uint64_t pixels);

} // namespace stromboli
