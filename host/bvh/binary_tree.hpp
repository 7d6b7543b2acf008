#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// Node of the binary tree: inner, or a leaf of one item (what one leaf record of the layout is
/// to hold; the builder knows only its box).
struct BinaryNode {
    Bounds bounds;
    uint32_t left = 0;  ///< inner: node index; leaf: number of its item
    uint32_t right = 0; ///< inner: node index; leaf: 0, as the root is nobody's child

    bool isLeaf() const { return right == 0; }
};

/// A BVH over items 0..n-1, before any layout: 2n - 1 nodes depth first, so that a node's left
/// child follows it, and a subtree is a run of nodes. Without items there are no nodes.
struct BinaryTree {
    std::vector<BinaryNode> nodes;
    uint32_t depth = 0; ///< edges on the longest path from the root; <= depthCap
};

struct BuildOptions {
    uint32_t bins = 32;     ///< per axis, 2..64
    uint32_t depthCap = 48; ///< of the binary tree; the builder proves it for every input
    bool reinsert = true;   ///< improve the tree by moving subtrees (reinsertion.hpp)
};

/// Binned SAH over centroid bounds (Wald 2007), all three axes; median split where SAH finds
/// nothing (equal centroids) or the depth left is only just enough. Parallel, and the same tree
/// for any number of threads. Throws SceneError for boxes that are not finite or beyond
/// gpu::LARGEST_COORDINATE, and for more items than there can be records; UsageError for options
/// out of range.
BinaryTree buildBinaryTree(std::span<const Bounds> items, const BuildOptions& options = {});

} // namespace stromboli
