#pragma once

#include "host/bvh/binary_tree.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::bvh {

// --- Slots of children ---------------------------------------------------------------------------

/// The slot of each of up to 8 children, so that `slot ^ octant` orders them front to back for rays
/// of every octant, as well as can be: children on the high side of axis k go to slots whose bit k
/// is set (Ylitie, Karras and Laine 2017, section 3.2), the assignment with the greatest sum of
/// offsets along the slots' diagonals, weighted by the children's areas. The best one, by dynamic
/// programming over the sets of slots taken.
std::array<uint8_t, gpu::WIDE_CHILDREN> assignSlots(std::span<const Bounds> children);

// --- The wide tree -------------------------------------------------------------------------------

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
