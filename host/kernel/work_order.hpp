#pragma once

#include "host/render/backend.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// Puts targets (in row order) into the order in which lanes take them: 8 x 8 tiles stay together,
/// so that a workgroup's rays are alike, and neighbouring workgroups are far apart in the picture,
/// because a driver that gives each thread one contiguous share of a dispatch (lavapipe does)
/// would leave the thread with the empty half idle.
std::vector<PixelTarget> interleave(std::span<const PixelTarget> targets, uint32_t width);

} // namespace stromboli
