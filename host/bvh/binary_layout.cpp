#include "host/bvh/binary_layout.hpp"

#include <algorithm>

namespace stromboli {

namespace {

/// One child of a gpu::Node.
struct Child {
    glm::vec3 low{gpu::LARGEST_COORDINATE};
    glm::vec3 high{-gpu::LARGEST_COORDINATE};
    uint32_t reference = gpu::CHILD_NONE; ///< absent, with the inverted box above
};

Child leafChild(const BinaryNode& leaf) {
    if (leaf.count == 0) return {};
    return {leaf.bounds.lo, leaf.bounds.hi,
            gpu::CHILD_LEAF_BIT | ((leaf.count - 1) << gpu::CHILD_COUNT_SHIFT) | leaf.first};
}

gpu::Node makeNode(const Child& left, const Child& right) {
    return {left.low, left.reference, left.high, right.reference, right.low, 0, right.high, 0};
}

/// A traversal that goes on with the nearer child and pushes the farther one has, at a node at
/// depth d, pushed at most one entry for each of the d nodes above it that is still on the stack.
/// Inner nodes have depth <= depth - 1, so after their own push the stack holds at most
/// (depth - 1) + 1 entries. At least 1, as shaders cannot have empty arrays.
uint32_t stackSizeFor(uint32_t depth) {
    return std::max(depth, 1u);
}

/// The inner nodes depth first: a left child follows its parent at once and is likely in the same
/// cache line or the next.
std::vector<gpu::Node> layOutInnerNodes(const BinaryTree& tree) {
    struct Pending {
        uint32_t node;   ///< of the tree
        uint32_t parent; ///< of the layout: whose right child it is, or CHILD_NONE
    };
    std::vector<gpu::Node> nodes;
    nodes.reserve(tree.nodes.size() / 2);
    std::vector<Pending> pending{{0, gpu::CHILD_NONE}};
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const BinaryNode& node = tree.nodes[next.node];
        const uint32_t index = uint32_t(nodes.size());
        if (next.parent != gpu::CHILD_NONE) nodes[next.parent].right = index;

        const BinaryNode& left = tree.nodes[node.left];
        const BinaryNode& right = tree.nodes[node.right];
        const auto child = [](const BinaryNode& n, uint32_t innerIndex) {
            return n.count > 0 ? leafChild(n) : Child{n.bounds.lo, n.bounds.hi, innerIndex};
        };
        // The right child's index is known once the left subtree is laid out.
        nodes.push_back(makeNode(child(left, index + 1), child(right, gpu::CHILD_NONE)));
        if (right.count == 0) pending.push_back({node.right, index});
        if (left.count == 0) pending.push_back({node.left, gpu::CHILD_NONE});
    }
    return nodes;
}

} // namespace

BinaryLayout layOut(const BinaryTree& tree) {
    const BinaryNode& root = tree.nodes.front();
    const bool rootIsLeaf = tree.nodes.size() == 1;
    BinaryLayout layout;
    layout.nodes = rootIsLeaf ? std::vector{makeNode(leafChild(root), {})} : layOutInnerNodes(tree);
    layout.primitiveOrder = tree.order;
    layout.stackSize = stackSizeFor(tree.depth);
    return layout;
}

} // namespace stromboli
