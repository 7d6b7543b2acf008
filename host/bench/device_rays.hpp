#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/settings.hpp"
#include "host/vulkan/buffer.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/ray_types.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stromboli::bench {

// --- Sets of rays --------------------------------------------------------------------------------

/// Rays of one kind, all contestants' alike.
struct RaySet {
    std::string name;
    bool anyHit = false; ///< shadow rays: is anything in the way?
    std::vector<gpu::TracedRay> rays;
};

struct RaySets {
    RaySet camera{"camera", false, {}};
    RaySet shadow{"shadow", true, {}};
    RaySet bounce{"bounce", false, {}}; ///< cosine-distributed

    uint64_t largest() const {
        return std::max({camera.rays.size(), shadow.rays.size(), bounce.rays.size()});
    }
};

/// Rays as paths make them, once, in double precision on the CPU and rounded to float: jittered
/// camera rays; from where they hit, one shadow ray each to a point of an emitter taken at random
/// (those that could bring light; they end 2^-12 of their length before the emitter) and one bounce
/// ray. They start off the surface by the error bound of docs/theory/numerics.md, on the side they
/// go to. In tiles of 8 x 8 pixels, in the order in which the kernel takes pixels. A pure function
/// of its arguments. perPixel: camera rays a pixel.
RaySets makeRaySets(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                    uint32_t perPixel);

/// Ray sets as makeRaySets() makes them, for a scene with placements. The reference has no tree of
/// such a scene, so rays are traced through the device's; bounces go by geometric normals, and
/// shadow rays to anywhere in the sky.
RaySets makePlacedRaySets(const Scene& scene, const WideLayout& layout, const Camera& camera,
                          const RenderSettings& settings, uint32_t perPixel);

// --- Rays on the device --------------------------------------------------------------------------

/// What tracing a ray set found, summed: equal work leaves equal sums, and a compiler cannot leave
/// out work whose result is used.
struct RayTotals {
    uint64_t hits = 0;
    double distances = 0;     ///< sum of t over closest hits
    double deviceSeconds = 0; ///< 0: no device clock
};

/// How the ray kernel runs.
struct RayTuning {
    DeviceTuning kernel;
    uint32_t raysPerLane = 1; ///< one after the other
};

/// Bytes of the largest buffer that the ray kernel reads row by row: of the scene, or of a ray set
/// of that size.
uint64_t rowBytes(const GpuScene& scene, uint64_t mostRays);

/// What suits the device, and buffers of up to so many bytes (rowBytes).
RayTuning rayTuning(const vulkan::Device& device, uint64_t rowBytes = 0);

/// Traces ray sets on the device with the kernel's own traversal (shaders/trace_rays.comp).
class DeviceRays {
  public:
    /// Uploads the scene. Throws DeviceError.
    DeviceRays(const vulkan::Device& device, const GpuScene& scene, const RayTuning& tuning);

    /// Uploads the rays (at least one); not part of the time of trace().
    void load(const RaySet& set);
    /// Traces the loaded rays once. Throws DeviceError if a lane met the loop limit.
    RayTotals trace();
    /// Where each loaded ray ended; the largest float for misses.
    std::vector<float> distances();

  private:
    vulkan::ComputePipeline makePipeline(bool anyHit, bool writeDistances) const;
    std::unique_ptr<vulkan::DescriptorSet> makeSet(const vulkan::ComputePipeline& pipeline) const;
    bool groupsTakeChunks() const;
    /// Returns the seconds it took (vulkan::Queue::run).
    double dispatch(const vulkan::ComputePipeline& pipeline, const vulkan::DescriptorSet& set);

    const vulkan::Device& device_;
    RayTuning tuning_;
    std::span<const uint32_t> code_;
    std::vector<uint32_t> constants_; ///< specialisation constants of the path kernel
    vulkan::Queue queue_;
    std::vector<vulkan::Buffer> sceneBuffers_;
    // What load() sets up:
    uint32_t rayCount_ = 0, chunks_ = 0, groups_ = 0;
    bool anyHit_ = false;
    std::optional<vulkan::Buffer> rays_, totals_, distances_;
    std::optional<vulkan::ComputePipeline> pipeline_;
    std::unique_ptr<vulkan::DescriptorSet> set_;
};

} // namespace stromboli::bench
