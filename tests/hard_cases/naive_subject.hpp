#pragma once

#include "host/stress/case.hpp"

#include <random>

namespace stromboli::test {

/// What the cases of host/stress must find wrong: a small path tracer in float that does it the way
/// textbooks and many renderers do. Its faults, each harmless in the scenes that its author tried:
/// - Moeller-Trumbore with a cut-off, spheres by b^2 - 4ac, boxes without slack, in
/// half precision to save memory, rounded to the nearest;
/// - rays start 1e-4 along the way, and shadow rays end at the emitter itself;
/// - only the shading normal says which side a direction is on;
/// - roulette without dividing by the probability; one emitter taken at random, without its
/// probability;
/// - pixels are sums in float of whatever samples there are;
/// - random numbers by a congruential generator, seeded by numbers in sequence, that may be 1;
/// - floats as compilers make them that are told to be fast: what is not above is below or equal,
/// negation is subtraction from zero, and digits are cut off;
/// - rays go on 1e-4 behind what they pass; shadow rays take all that is there for opaque;
/// - texture coordinates in half precision, and remainders that may be negative; normal maps divide
/// by the area of texture coordinates;
/// - texels of an environment as if all were of one size;
/// - media absorb and do nothing else, by the density in the middle of the way, and there is none
/// behind a border that a ray leaves;
/// - GGX with a least denominator; volumes that colour what passes their surface;
/// - groups of 8 x 8 pixels, as many as fit; random numbers that depend on the group.
class NaiveSubject : public stress::Subject {
  public:
    std::unique_ptr<stress::RayTracer> tracer(const Scene& scene) override;
    stress::Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           const KernelTuning& tuning, const ProgressCallback& progress) override;
    std::vector<stress::RandomBlock> randomBlocks(std::span<const stress::Words> counters) override;
    std::vector<stress::FloatFacts> floatFacts(std::span<const stress::FloatPair> pairs) override;
};

namespace naive {

struct Hit {
    float t = stress::kMissed;
    glm::vec3 geometric{0.0f}, shading{0.0f}; ///< unit, as the scene states them
    const Material* material = nullptr;
    const Triangle* triangle = nullptr; ///< null: a sphere

    explicit operator bool() const { return material != nullptr; }
};

/// Tries every primitive whose box the ray enters.
Hit closest(const Scene& scene, const glm::vec3& origin, const glm::vec3& direction, float tMin,
            float tMax);

/// A linear congruential generator of 32 bits.
class Random {
  public:
    explicit Random(uint32_t seed) : state_(seed) {}
    /// In [0, 1]: of 2^32 words the upper 128 are rounded to 1.
    float uniform() {
        state_ = state_ * 1664525u + 1013904223u;
        return float(state_) * 0x1p-32f;
    }

  private:
    uint32_t state_;
};

/// Radiance along a camera ray.
glm::vec3 radiance(const Scene& scene, const RenderSettings& settings, glm::vec3 origin,
                   glm::vec3 direction, float tMin, Random& random, uint64_t& rays);

} // namespace naive

} // namespace stromboli::test
