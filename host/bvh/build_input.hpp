#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/box4.hpp"

#include <span>
#include <vector>

namespace stromboli::bvh {

/// Throws UsageError where the options are outside the ranges BuildOptions states, or where
/// `primitives` of them cannot be had within the depth cap; SceneError where there are more
/// primitives than child references can name.
void checkBuild(size_t primitives, const BuildOptions& options);

/// The builder's copy of the primitives' boxes, in order, and their common bounds.
struct BuildInput {
    std::vector<BuildReference> references;
    RunBounds bounds;
};

/// Throws SceneError naming the first primitive whose box is inverted, not finite, or beyond
/// gpu::LARGEST_COORDINATE.
BuildInput readBounds(std::span<const Bounds> primitives);

/// The fewest levels below a node that n >= 1 primitives need:
/// ceil(log2(ceil(n / maxLeafSize))).
uint32_t levelsNeeded(size_t n, uint32_t maxLeafSize);

} // namespace stromboli::bvh
