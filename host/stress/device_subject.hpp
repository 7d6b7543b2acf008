#pragma once

#include "host/stress/case.hpp"
#include "host/vulkan/device.hpp"

namespace stromboli::stress {

/// The product on a Vulkan device: its path kernel, its traversal and its random numbers. The
/// device must outlive it. Its functions throw DeviceError.
class DeviceSubject final : public Subject {
  public:
    explicit DeviceSubject(const vulkan::Device& device) : device_(device) {}

    std::unique_ptr<RayTracer> tracer(const Scene& scene) override;
    Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                   const KernelTuning& tuning, const ProgressCallback& progress) override;
    std::vector<RandomBlock> randomBlocks(std::span<const Words> counters) override;
    std::vector<FloatFacts> floatFacts(std::span<const FloatPair> pairs) override;

  private:
    const vulkan::Device& device_;
};

} // namespace stromboli::stress
