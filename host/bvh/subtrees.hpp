#pragma once

#include "host/bvh/binary_tree.hpp"

#include <cstdint>
#include <vector>

namespace stromboli::bvh {

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
