#pragma once

#include "host/render/backend.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// Puts targets (in row order) into the order in which lanes take them: tile by tile of 8 x 8
/// pixels, so that the rays of lanes that work side by side are alike. Pixels that need no more
/// samples are not in the list, and lanes take the next item whenever they are done with one, so
/// the order need not balance anything.
std::vector<PixelTarget> tileOrder(std::span<const PixelTarget> targets, uint32_t width);

} // namespace stromboli
