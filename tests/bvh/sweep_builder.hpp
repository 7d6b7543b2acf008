#pragma once

#include "host/bvh/binary_tree.hpp"

#include <span>

namespace stromboli::test {

/// Area of all inner nodes, relative to the root's, of the tree that a top-down builder makes which
/// tries every split between two boxes in centroid order on every axis: what binning
/// approximates. No depth cap. Slow and plain on purpose.
double sweepInnerArea(std::span<const Bounds> boxes);

} // namespace stromboli::test
