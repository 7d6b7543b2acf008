#pragma once

#include "host/bvh/binary_tree.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::bvh {

// --- Which nodes stay ----------------------------------------------------------------------------

/// Up to eight subtrees of the binary tree, in its order.
struct SubtreeGroup {
    std::array<Subtree, gpu::WIDE_CHILDREN> subtree;
    uint32_t count = 0;
};

/// Which nodes of a binary tree become nodes of the wide one, so that a random line visits the
/// fewest records, node and leaf records alike (Ylitie, Karras and Laine 2017, section 4). Leaves
/// stay leaves.
class CollapsePlan {
  public:
    /// `tree` must outlive the plan.
    explicit CollapsePlan(const BinaryTree& tree);

    /// Those whose roots are to be the children of this one's root, an inner node: 2 to 8.
    SubtreeGroup childrenOf(Subtree subtree) const;

  private:
    struct Entry {
        /// [j - 1]: the areas of all records of the subtree together, if it is given at most j
        /// records at its top, j = 1..7.
        float cost[gpu::WIDE_CHILDREN - 1];
        /// Four bits each for j = 1..8: how many of the j records the left child gets; 0: as for
        /// j - 1, and for j = 1 a record for the node itself.
        uint32_t choice;

        uint32_t choiceOf(uint32_t j) const { return choice >> (4 * (j - 1)) & 15u; }
        void choose(uint32_t j, uint32_t toLeft) { choice |= toLeft << (4 * (j - 1)); }
    };
    void plan(uint32_t node);

    const BinaryTree& tree_;
    float inverseRootArea_; ///< areas are relative to the root's, so that sums stay in range
    std::vector<Entry> entries_;
};

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
