#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

// --- The binary tree -----------------------------------------------------------------------------

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

/// How far the boxes of items are split before the tree is built (split_items.hpp). The figures are
/// those with which no kind of ray in real rooms visits more records than without splits
/// (docs/results.md, "Experiments with the tree").
struct SplitOptions {
    /// Most boxes beyond one for each item, as a share of the items; 0: none is split.
    double most = 0.3;
    /// A box is split only if the two parts have together this share less of its area: what it
    /// saves has to outweigh the nodes that lead to one more record.
    double leastShare = 0.3;
    /// And only if that is this many times the median of the items' areas: small boxes are met by
    /// few rays.
    double leastGain = 1;
};

struct BuildOptions {
    uint32_t bins = 32;     ///< per axis, 2..64
    uint32_t depthCap = 48; ///< of the binary tree; the builder proves it for every input
    bool reinsert = true;   ///< improve the tree by moving subtrees (reinsertion.hpp)
    SplitOptions split;
};

/// Binned SAH over centroid bounds (Wald 2007), all three axes; median split where SAH finds
/// nothing (equal centroids) or the depth left is only just enough. Parallel, and the same tree
/// for any number of threads. Throws SceneError for boxes that are not finite or beyond
/// gpu::LARGEST_COORDINATE, and for more items than there can be records; UsageError for options
/// out of range.
BinaryTree buildBinaryTree(std::span<const Bounds> items, const BuildOptions& options = {});

} // namespace stromboli

namespace stromboli::bvh {

// --- Subtrees ------------------------------------------------------------------------------------

/// The nodes of a subtree: the run [first, end) of BinaryTree::nodes, first being its root.
struct Subtree {
    uint32_t first, end;
    uint32_t size() const { return end - first; }
};

inline Subtree wholeTree(const BinaryTree& tree) {
    return {0, uint32_t(tree.nodes.size())};
}
inline Subtree leftOf(const BinaryTree& tree, Subtree s) {
    return {tree.nodes[s.first].left, tree.nodes[s.first].right};
}
inline Subtree rightOf(const BinaryTree& tree, Subtree s) {
    return {tree.nodes[s.first].right, s.end};
}

/// A tree cut for parallel work: subtrees of at most `mostNodes` nodes, in order, and the nodes
/// above them, parents first.
struct CutTree {
    std::vector<Subtree> subtrees;
    std::vector<uint32_t> above;
};
CutTree cut(const BinaryTree& tree, uint32_t mostNodes);

} // namespace stromboli::bvh
