#pragma once

#include "host/bvh/binary_layout.hpp"
#include "host/bvh/binary_tree.hpp"

#include <array>
#include <cstdint>

namespace stromboli {

struct BvhStatistics {
    uint32_t nodes = 0; ///< inner nodes and leaves of the tree
    uint32_t leaves = 0;
    uint32_t depth = 0;                      ///< edges on the longest path from the root
    std::array<uint32_t, 17> leavesOfSize{}; ///< [n]: leaves with n primitives
    double sahCost = 0;                      ///< see sahCost()
    uint64_t layoutBytes = 0;                ///< of the nodes and the primitive order
};

/// Expected cost of a random line that meets the root's box (Goldsmith and Salmon 1987): over all
/// inner nodes the traversal cost, over all leaves the intersection cost of their primitives,
/// each times the node's area relative to the root's. 0 if the root has no area.
double sahCost(const BinaryTree& tree, const BuildOptions& options);

/// `options` must be the ones the tree was built with, `layout` the tree's.
BvhStatistics measure(const BinaryTree& tree, const BinaryLayout& layout,
                      const BuildOptions& options);

} // namespace stromboli
