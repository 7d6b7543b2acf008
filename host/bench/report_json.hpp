#pragma once

#include "host/bench/report.hpp"

#include "host/core/json.hpp"

namespace stromboli::bench {

/// All of the report, every single measurement included; times in seconds for one item (build, ray,
/// path, byte). Comparisons are against the first contestant of a list, which is ours.
Json toJson(const BenchReport& report);

} // namespace stromboli::bench
