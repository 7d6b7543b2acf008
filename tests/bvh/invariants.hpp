#pragma once

#include "host/bvh/binary_layout.hpp"
#include "host/bvh/binary_tree.hpp"

#include <span>

namespace stromboli::test {

/// Reports a test failure for anything that makes the tree not a BVH of these primitives, of the
/// shape the options demand: boxes that do not enclose what is below, primitives in no leaf or in
/// several, children before parents, leaves too large, the wrong depth.
void expectValidTree(const BinaryTree& tree, std::span<const Bounds> primitives,
                     const BuildOptions& options);

/// The same for the layout of a valid tree: references decode to the tree's leaves, nodes are
/// depth first, boxes are the children's, the stack holds the deepest descent.
void expectValidLayout(const BinaryLayout& layout, const BinaryTree& tree);

} // namespace stromboli::test
