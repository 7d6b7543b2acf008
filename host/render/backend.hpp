#pragma once

#include "host/film/film.hpp"
#include "host/render/kept_pixels.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace stromboli {

// --- Backends ------------------------------------------------------------------------------------

/// A pixel that is to have `samples` samples after the pass (it may have some already).
struct PixelTarget {
    uint32_t pixel = 0; ///< of those that are rendered, counted row by row (Film::pixels)
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
/// backend to stop early: it begins no further sample, and leaves a valid film, whose pixels are
/// not biased by which samples were under way (docs/theory/noise.md, "A render that is stopped").
/// It may be called again while samples under way are ended.
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
    /// `count` samples of a pixel, each by itself, from number `first` on.
    virtual std::vector<SampleValue> samplesAlone(uint32_t pixel, uint32_t first, uint32_t count);
    virtual RenderCounters counters() const = 0;
    /// Forgets all samples, whose film the caller empties; those to come are numbered from here on:
    /// the first is the pixel's sample `firstSample`. Throws std::logic_error where a backend
    /// cannot.
    virtual void beginAt(uint32_t firstSample);
    /// The statistics of pixels to the last bit; `film` is the one that sample() has filled. A run
    /// of none says how they are kept. Here: of a backend that keeps nothing of its own beside the
    /// film.
    virtual KeptPixels save(const Film& film, PixelRun run);
    /// Goes on from there: in a backend of the same kind, made for the same picture. Fills in the
    /// film's pixels. Throws std::invalid_argument if their number is another, or if they are not
    /// of the picture.
    virtual void restore(PixelRun run, const KeptPixels& pixels, Film& film);
    /// All pixels.
    KeptPixels saveAll(const Film& film);
    void restoreAll(const KeptPixels& pixels, Film& film);
    /// What a backend that adds up blocks (BlockBackend) keeps of those that are done; else
    /// nothing.
    virtual std::vector<ExactStatistics> saveBlocks() const { return {}; }
    /// To be called before restore(). Throws std::invalid_argument if there are blocks and the
    /// backend has no use for them.
    virtual void restoreBlocks(std::span<const ExactStatistics> blocks);
};

} // namespace stromboli
