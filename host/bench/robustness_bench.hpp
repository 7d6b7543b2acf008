#pragma once

#include "host/bench/contestants.hpp"
#include "host/bench/ray_sets.hpp"
#include "host/bench/report.hpp"

namespace stromboli::bench {

/// What robustness costs: the kernels that renders use against the same ones with plain code
/// (plain_kernels.hpp), rays and whole paths.
RobustnessReport benchRobustness(const Arena& arena, const GpuScene& gpu, const RaySets& sets);

} // namespace stromboli::bench
