#pragma once

#include "host/bvh/binary_tree.hpp"

#include <span>

namespace stromboli::test {

/// SAH cost of the tree that a top-down builder makes which tries every split between two
/// primitives in centroid order on every axis: what binning approximates. Same costs, leaf rule
/// and largest leaf as the options; no depth cap. Slow and plain on purpose.
double sweepSahCost(std::span<const Bounds> primitives, const BuildOptions& options);

} // namespace stromboli::test
