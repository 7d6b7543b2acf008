#pragma once

#include "host/film/film.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/sampling_session.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/ray_types.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace stromboli::stress {

using Ray = gpu::TracedRay;

/// Where a ray ends that hits nothing.
inline constexpr float kMissed = 3.402823466e38f;

/// Traces rays through one scene.
class RayTracer {
  public:
    virtual ~RayTracer() = default;
    /// How many of the rays hit something. anyHit: stop at the first hit, as shadow rays do.
    virtual uint64_t countHits(std::span<const Ray> rays, bool anyHit) = 0;
    /// Of each ray's closest hit, in lengths of its direction, or kMissed.
    virtual std::vector<float> distances(std::span<const Ray> rays) = 0;
};

struct Picture {
    Film film;
    uint64_t rays = 0; ///< traced for it
};

/// Four counters (pixel, sample, block, seed), and what the hash makes of them.
using Words = std::array<uint32_t, 4>;
struct RandomBlock {
    Words words;
    std::array<float, 4> numbers; ///< in [0, 1)
};

/// Two floats, and what arithmetic makes of them.
struct FloatPair {
    float a, b;
};
struct FloatFacts {
    std::array<float, 4> results{}; ///< a + b, a - b, a b, -a
    /// A bit each, from the lowest: a < b, a <= b, a > b, a >= b, a == b, a != b, not a < b.
    uint32_t comparisons = 0;
};

/// What the cases put to the test. The product is DeviceSubject; tests put naive code in its
/// place, to see that a case can fail.
class Subject {
  public:
    virtual ~Subject() = default;
    virtual std::unique_ptr<RayTracer> tracer(const Scene& scene) = 0;
    /// `tuning` says how to work, and must not change the picture.
    virtual Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           const KernelTuning& tuning, const ProgressCallback& progress) = 0;
    virtual std::vector<RandomBlock> randomBlocks(std::span<const Words> counters) = 0;
    virtual std::vector<FloatFacts> floatFacts(std::span<const FloatPair> pairs) = 0;
};

} // namespace stromboli::stress
