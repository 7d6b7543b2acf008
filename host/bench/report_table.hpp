#pragma once

#include "host/bench/report.hpp"

#include <string>

namespace stromboli::bench {

/// The report for people: lines of at most 100 characters or so. Figures are medians, with the
/// least and the most in brackets; "x" figures are medians of the ratios of each round, above 1
/// where ours is the faster.
std::string toTable(const BenchReport& report);

} // namespace stromboli::bench
