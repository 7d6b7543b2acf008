#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/wide_layout.hpp"

#include <span>

namespace stromboli::test {

/// Reports a test failure for anything that makes the tree not a BVH of these items, of the shape
/// the builder promises: boxes that are not those of what is below, items in no leaf or in
/// several, nodes that are not depth first, the wrong depth.
void expectValidTree(const BinaryTree& tree, std::span<const Bounds> items, uint32_t depthCap);

/// Checks a scene's layout likewise: every primitive in one leaf, where placeOf says and with its
/// own corners, or in copies of that leaf, which are together reached by way of all its points; in
/// every node boxes that hold all that is below and the margin; absent children that do no harm; a
/// stack for the deepest way down.
void expectValidLayout(const WideLayout& layout, const Scene& scene);

} // namespace stromboli::test
