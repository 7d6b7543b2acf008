#include "host/bvh/linked_tree.hpp"

#include <algorithm>

namespace stromboli::bvh {

LinkedTree::LinkedTree(const BinaryTree& tree) : nodes_(tree.nodes.size()) {
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
        const BinaryNode& from = tree.nodes[i];
        Node& to = nodes_[i];
        const glm::vec3 &lo = from.bounds.lo, &hi = from.bounds.hi;
        to.box = {Float4{lo.x, lo.y, lo.z, 0}, Float4{hi.x, hi.y, hi.z, 0}};
        to.area = to.box.halfArea();
        to.left = from.isLeaf() ? kNone : from.left;
        to.right = from.isLeaf() ? kNone : from.right;
        if (i == 0) to.parent = kNone;
        if (!from.isLeaf()) nodes_[from.left].parent = nodes_[from.right].parent = i;
    }
}

uint32_t LinkedTree::sibling(uint32_t node) const {
    const Node& parent = nodes_[nodes_[node].parent];
    return parent.left == node ? parent.right : parent.left;
}

double LinkedTree::innerArea() const {
    double sum = 0;
    for (const Node& node : nodes_)
        if (!node.isLeaf()) sum += node.area;
    return sum;
}

bool LinkedTree::canMove(uint32_t subtree, uint32_t beside) const {
    const uint32_t parent = nodes_[subtree].parent;
    if (parent == kNone || nodes_[parent].parent == kNone) return false;
    if (beside == 0 || beside == parent || beside == sibling(subtree)) return false;
    uint32_t ancestor = beside;
    while (ancestor != kNone && ancestor != subtree)
        ancestor = nodes_[ancestor].parent;
    return ancestor == kNone;
}

double LinkedTree::move(uint32_t subtree, uint32_t beside) {
    // The parent goes along and becomes the new common parent.
    const uint32_t parent = nodes_[subtree].parent, grandparent = nodes_[parent].parent;
    replaceChild(grandparent, parent, sibling(subtree));
    double grown = refitUpwards(grandparent);
    const uint32_t newGrandparent = nodes_[beside].parent;
    replaceChild(newGrandparent, beside, parent);
    nodes_[parent].left = beside;
    nodes_[parent].right = subtree;
    nodes_[beside].parent = nodes_[subtree].parent = parent;
    grown += refitNode(parent);
    return grown + refitUpwards(newGrandparent);
}

BinaryTree LinkedTree::depthFirst(const BinaryTree& original) const {
    struct Pending {
        uint32_t node;
        uint32_t parent; ///< whose right child it is, or kNone
        uint32_t depth;
    };
    BinaryTree tree;
    tree.nodes.reserve(nodes_.size());
    std::vector<Pending> pending{{0, kNone, 0}};
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const Node& from = nodes_[next.node];
        const uint32_t index = uint32_t(tree.nodes.size());
        if (next.parent != kNone) tree.nodes[next.parent].right = index;
        tree.depth = std::max(tree.depth, next.depth);
        if (from.isLeaf()) {
            tree.nodes.push_back(original.nodes[next.node]);
            continue;
        }
        tree.nodes.push_back({from.box.bounds(), index + 1, 0});
        pending.push_back({from.right, index, next.depth + 1});
        pending.push_back({from.left, kNone, next.depth + 1});
    }
    return tree;
}

void LinkedTree::replaceChild(uint32_t parent, uint32_t child, uint32_t by) {
    Node& node = nodes_[parent];
    (node.left == child ? node.left : node.right) = by;
    nodes_[by].parent = parent;
}

double LinkedTree::refitNode(uint32_t index) {
    Node& node = nodes_[index];
    const float before = node.area;
    node.box = nodes_[node.left].box;
    node.box.extend(nodes_[node.right].box);
    node.area = node.box.halfArea();
    return double(node.area) - double(before);
}

double LinkedTree::refitUpwards(uint32_t node) {
    double grown = 0;
    for (; node != kNone; node = nodes_[node].parent)
        grown += refitNode(node);
    return grown;
}

} // namespace stromboli::bvh
