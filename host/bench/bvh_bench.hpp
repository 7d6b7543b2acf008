#pragma once

#include "host/bench/contestants.hpp"
#include "host/bench/report.hpp"

namespace stromboli::bench {

/// Building: ours (and its binary tree alone) against Embree's high and medium quality, the same
/// number of threads, the scene's arrays at hand. Ours includes the layout for the device, Embree's
/// its own.
BvhReport benchBvh(const Arena& arena);

} // namespace stromboli::bench
