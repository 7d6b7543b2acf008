#pragma once

#include "host/bench/embree_world.hpp"
#include "host/render/backend.hpp"

namespace stromboli::bench {

/// The path tracer that the kernel is compared with: C++ on Embree, one sample after the other on
/// each thread, in float, compiled for each set of features a scene may need.
class EmbreePaths final : public Backend {
  public:
    EmbreePaths(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                const native::Tracer& tracer, uint32_t threads)
        : world_(scene, camera, settings, tracer), threads_(threads) {}

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override;
    /// A rejected sample's radiance is given as 0.
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override;
    RenderCounters counters() const override { return counters_; }

  private:
    EmbreeWorld world_;
    uint32_t threads_;
    RenderCounters counters_;
};

} // namespace stromboli::bench
