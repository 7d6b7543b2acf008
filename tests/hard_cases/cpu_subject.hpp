#pragma once

#include "host/stress/case.hpp"

namespace stromboli::test {

/// The product's code for the CPU: the traversal of host/bvh in float, the reference path tracer in
/// double precision. It has no random words of its own (randomBlocks gives none).
class CpuSubject final : public stress::Subject {
  public:
    std::unique_ptr<stress::RayTracer> tracer(const Scene& scene) override;
    stress::Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           const KernelTuning& tuning, const ProgressCallback& progress) override;
    std::vector<stress::RandomBlock> randomBlocks(std::span<const stress::Words>) override {
        return {};
    }
    std::vector<stress::FloatFacts> floatFacts(std::span<const stress::FloatPair> pairs) override;
};

} // namespace stromboli::test
