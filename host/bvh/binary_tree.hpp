#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// Node of the binary tree that the SAH builder makes: inner (count = 0, two children) or leaf.
struct BinaryNode {
    Bounds bounds;
    uint32_t left = 0, right = 0;  ///< inner: node indices
    uint32_t first = 0, count = 0; ///< leaf: a run of BinaryTree::order
};

/// A BVH over primitives 0..n-1, before any layout. nodes[0] is the root, children follow their
/// parents. Without primitives: one leaf with count 0 and empty bounds.
struct BinaryTree {
    std::vector<BinaryNode> nodes;
    std::vector<uint32_t> order; ///< primitive indices; each primitive exactly once
    uint32_t depth = 0;          ///< edges on the longest path from the root; <= depthCap
};

struct BuildOptions {
    uint32_t maxLeafSize = 4;      ///< 1..16
    uint32_t bins = 32;            ///< per axis, 2..64
    float traversalCost = 1.0f;    ///< of a node's two box tests, in units of ...
    float intersectionCost = 1.0f; ///< ... one primitive test
    uint32_t depthCap = 48;        ///< the builder proves depth <= depthCap for every input
};

/// Binned SAH over centroid bounds (Wald 2007), all three axes; median split where SAH finds
/// nothing (equal centroids) or the depth left is only just enough. Parallel, and the same tree
/// for any number of threads.
BinaryTree buildBinaryTree(std::span<const Bounds> primitives, const BuildOptions& options = {});

} // namespace stromboli
