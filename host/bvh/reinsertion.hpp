#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/binned_split.hpp"

#include <cstdint>
#include <vector>

namespace stromboli::bvh {

// --- A tree whose subtrees can move --------------------------------------------------------------

/// A binary tree whose subtrees can be moved: nodes know their parents, in any order.
class LinkedTree {
  public:
    static constexpr uint32_t kNone = 0xFFFFFFFFu;

    struct Node {
        Box4 box;
        uint32_t left, right; ///< kNone, kNone: a leaf
        uint32_t parent;      ///< kNone: the root, which is node 0
        float area;           ///< half the box's

        bool isLeaf() const { return left == kNone; }
    };

    explicit LinkedTree(const BinaryTree& tree);

    const Node& operator[](uint32_t i) const { return nodes_[i]; }
    uint32_t size() const { return uint32_t(nodes_.size()); }
    uint32_t sibling(uint32_t node) const;
    double innerArea() const; ///< sum over all inner nodes

    /// A subtree can be taken out where its parent is not the root, and put beside any node but the
    /// root, its own parent and sibling, and what is in the subtree itself.
    bool canMove(uint32_t subtree, uint32_t beside) const;

    /// Takes the subtree out, its sibling takes the place of their parent, and puts it beside the
    /// given node, under a new common parent. Returns by how much the areas of all inner nodes
    /// have grown together.
    double move(uint32_t subtree, uint32_t beside);

    /// The tree with nodes depth first. `original` is the one this was made from.
    BinaryTree depthFirst(const BinaryTree& original) const;

  private:
    void replaceChild(uint32_t parent, uint32_t child, uint32_t by);
    double refitNode(uint32_t node);
    double refitUpwards(uint32_t node);

    std::vector<Node> nodes_;
};

// --- Reinsertion ---------------------------------------------------------------------------------

/// Improves a tree by taking subtrees out and putting them back where the areas of all boxes grow
/// least (Bittner, Hapala and Havran 2013; the search in parallel after Meister and Bittner 2018,
/// "Parallel Reinsertion for Bounding Volume Hierarchy Optimization"). It undoes what top-down
/// building does worst: large items, such as the walls of a room, in a subtree with small ones.
/// The sum of the areas of the inner nodes never grows; depth stays within the cap, or the tree
/// stays as it is. The same for any number of threads.
void reinsertSubtrees(BinaryTree& tree, uint32_t depthCap);

} // namespace stromboli::bvh
