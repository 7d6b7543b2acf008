#pragma once

#include "host/film/film.hpp"
#include "host/film/fixed_sum.hpp"

#include <array>
#include <cstdint>

namespace stromboli {

/// Statistics of a pixel's samples that can be put together from blocks of them in any order and
/// grouping, to the same bits. A block's own statistics are rounded when it is added; from then on
/// sums are exact, and mean and variance are worked out once, when they are asked for
/// (docs/farm.md, "What a film adds up").
struct ExactStatistics {
    /// Of radiance. A film's samples are at most 2^48 each, negative where a pixel filter is, and
    /// at most 2^24.
    using Sum = FixedSum<4, -180>;
    /// Of squared radiance.
    using Squares = FixedSum<5, -192>;

    uint32_t count = 0, rejected = 0;
    uint32_t firstRejected = 0xFFFFFFFFu; ///< counted from the pixel's first sample
    std::array<Sum, 3> sum;               ///< of the samples
    /// Of each block's squared deviations from its mean, and its squared sum over its count.
    std::array<Squares, 3> squares;

    uint32_t taken() const { return count + rejected; }
    /// Adds a block of samples, the first of which is the pixel's sample `firstSample`. Throws
    /// SceneError if their radiance is out of range.
    void add(const PixelStatistics& block, uint32_t firstSample);
    void add(const ExactStatistics& other);
    /// Of a single block, they are what was added.
    PixelStatistics statistics() const;

    bool operator==(const ExactStatistics&) const = default;
};

} // namespace stromboli
