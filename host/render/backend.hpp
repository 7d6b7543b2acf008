#pragma once

#include "host/film/film.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace stromboli {

/// A pixel that is to have `samples` samples after the pass (it may have some already).
struct PixelTarget {
    uint32_t pixel = 0; ///< y * width + x in the whole picture, row 0 at the top
    uint32_t samples = 0;
};

/// What a backend counted since it was made.
struct RenderCounters {
    uint64_t paths = 0;
    uint64_t rays = 0; ///< camera, bounce, shadow and hemisphere rays traced
};

/// One sample by itself.
struct SampleValue {
    glm::dvec3 radiance{0.0};
    bool rejected = false; ///< not finite, negative or too large for a film
};

/// Called now and then with the number of samples done in this pass; returning false asks the
/// backend to stop early, leaving the film valid.
using PassProgress = std::function<bool(uint64_t samplesDone)>;

/// Something that takes samples of a picture: the Vulkan kernel or the CPU reference.
class Backend {
  public:
    virtual ~Backend() = default;
    /// Brings every listed pixel of the film to its target. Sample i of a pixel is the same
    /// whatever the pass it is taken in.
    virtual void sample(std::span<const PixelTarget> targets, Film& film,
                        const PassProgress& progress) = 0;
    /// Sample number `sample` of a pixel, to the last bit as sample() takes it.
    virtual SampleValue sampleAlone(uint32_t pixel, uint32_t sample) = 0;
    virtual RenderCounters counters() const = 0;
};

} // namespace stromboli
