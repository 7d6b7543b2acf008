#pragma once

#include "host/bvh/binary_tree.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace stromboli::bvh {

/// An inner node of the 8-wide tree: its children by slot, nodes of the binary tree.
struct WideNode {
    std::array<uint32_t, gpu::WIDE_CHILDREN> child{}; ///< where a bit below says there is one
    uint8_t nodes = 0, leaves = 0;                    ///< masks of slots

    bool isNode(uint32_t slot) const { return nodes >> slot & 1; }
    bool isLeaf(uint32_t slot) const { return leaves >> slot & 1; }
    bool has(uint32_t slot) const { return isNode(slot) || isLeaf(slot); }
};

/// The wide tree's inner nodes, depth first, children in the order of their slots. There is always
/// a root, even over nothing.
std::vector<WideNode> collapse(const BinaryTree& tree);

} // namespace stromboli::bvh
