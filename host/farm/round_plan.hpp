#pragma once

#include "host/farm/film_header.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// A round of samples after the first: which pixels get more, and how many.
struct RoundPlan {
    /// Of the picture, and of the rounds before, whose checksums count and not what is held.
    FilmHeader picture;
    /// By pixel: the samples it has, and those it is to have. The numbers of samples go on, so that
    /// none is taken twice and Sobol points fill each other's gaps.
    std::vector<uint32_t> from, to;

    uint32_t round() const { return picture.rounds() + 1; }
    uint64_t samples() const;
    uint64_t pixels() const; ///< that get some
};

/// Of what a plan asks for and of the plans before it: the same plan of the same picture, whoever
/// wrote it.
uint32_t checksumOf(const RoundPlan& plan);

/// A pixel's samples of the round: those from number `from` to `to`, without the last.
struct PlannedPixel {
    uint32_t pixel = 0, from = 0, to = 0;
    auto operator<=>(const PlannedPixel&) const = default;
};

/// What one share takes of a round: some pixels, with all of their samples.
struct PlannedShare {
    FilmHeader header;                ///< of its film
    std::vector<PlannedPixel> pixels; ///< in the order of the picture
};

/// The pixels of a plan lie in tiles, whose order is mixed, and a share has neighbours in that
/// order, so that each has about as much of the costly parts of the picture. Shares are cut by
/// samples: about as many in each.
PlannedShare ofShare(const RoundPlan& plan, const ShareName& share);

} // namespace stromboli
