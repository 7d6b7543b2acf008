#pragma once

#include "host/film/film.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

/// Bytes of the host's memory that a render takes for each pixel, at most: film, noise estimate,
/// lists of work, steps of the plan; in blocks: that of the block, and exact sums.
uint64_t hostBytesPerPixel(bool inBlocks = false);

/// The rows of what is rendered, from the top, in bands of about the same height and of at most
/// `pixels` pixels each (at least one row). One band if all of it fits.
std::vector<PictureArea> bandsOf(const PictureArea& area, uint64_t pixels);
/// The same by their number, which is not larger than that of the rows.
std::vector<PictureArea> inBands(const PictureArea& area, uint32_t count);

} // namespace stromboli
