#pragma once

#include "host/bvh/binary_tree.hpp"

#include <cstdint>

namespace stromboli::bvh {

/// Improves a tree by taking subtrees out and putting them back where the areas of all boxes grow
/// least (Bittner, Hapala and Havran 2013; the search in parallel after Meister and Bittner 2018,
/// "Parallel Reinsertion for Bounding Volume Hierarchy Optimization"). It undoes what top-down
/// building does worst: large items, such as the walls of a room, in a subtree with small ones.
/// The sum of the areas of the inner nodes never grows; depth stays within the cap, or the tree
/// stays as it is. The same for any number of threads.
void reinsertSubtrees(BinaryTree& tree, uint32_t depthCap);

} // namespace stromboli::bvh
