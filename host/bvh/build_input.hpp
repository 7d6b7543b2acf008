#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/box4.hpp"

#include <span>
#include <vector>

namespace stromboli::bvh {

/// Throws UsageError where the options are outside the ranges BuildOptions states, or where so
/// many items cannot be had within the depth cap; SceneError where there are more items than
/// records.
void checkBuild(size_t items, const BuildOptions& options);

/// The builder's copy of the items' boxes, in order, and their common bounds.
struct BuildInput {
    std::vector<BuildReference> references;
    RunBounds bounds;
};

/// Throws SceneError naming the first item whose box is inverted, not finite, or beyond
/// gpu::LARGEST_COORDINATE.
BuildInput readBounds(std::span<const Bounds> items);

/// The fewest levels below a node that n >= 1 items need: ceil(log2(n)).
uint32_t levelsNeeded(size_t n);

} // namespace stromboli::bvh
