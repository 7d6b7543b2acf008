#pragma once

#include "host/film/film.hpp"
#include "shaders/shared/render_types.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// Pixels one after the other, row by row.
struct PixelRun {
    uint32_t first = 0, count = 0; ///< counted as PixelTarget::pixel
};

/// The statistics of pixels to the last bit, as the backend that took their samples has them: what
/// it needs to go on as if it had never stopped. Bytes, which only a backend of the same kind takes
/// back; everyone may look at the statistics.
struct KeptPixels {
    enum class As : uint32_t {
        Statistics, ///< as the film has them: backends that keep nothing beside it
        States,     ///< as gpu::PixelState: the kernel
    };
    As as = As::Statistics;
    uint32_t strands = 1; ///< states of a pixel
    std::vector<std::byte> bytes;

    size_t bytesPerPixel() const;
    /// Whether this is a kind that there is, and the bytes are those of whole pixels.
    bool isWhole() const;
    size_t count() const { return bytes.size() / bytesPerPixel(); }
    PixelStatistics statistics(size_t pixel) const;

    /// Makes it so many pixels without a sample.
    void empty(size_t pixels);
    /// Some of the pixels, by themselves.
    KeptPixels part(PixelRun run) const;
    /// Puts pixels of the same kind in the places of a run of as many.
    void put(PixelRun run, const KeptPixels& pixels);
    void append(const PixelStatistics& pixel);
    /// Those of all strands of a pixel, or of several pixels.
    void append(std::span<const gpu::PixelState> states);
    /// The states of all pixels, if that is what they are.
    std::span<const gpu::PixelState> states() const;

    /// Whether a backend that has pixels as these can go on with those.
    bool sameKind(const KeptPixels& other) const {
        return as == other.as && strands == other.strands;
    }
};

/// The statistics of a pixel from the states of all of its strands.
PixelStatistics statisticsOf(std::span<const gpu::PixelState> strands);

} // namespace stromboli
