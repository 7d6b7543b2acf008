#include "host/bvh/wide_tree.hpp"

#include "host/bvh/child_slots.hpp"
#include "host/bvh/collapse_plan.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace stromboli::bvh {

namespace {

constexpr uint32_t kTaskNodes = 1u << 13; // of the binary tree

class Collapse {
  public:
    explicit Collapse(const BinaryTree& tree) : tree_(tree), plan_(tree) {}

    std::vector<WideNode> run() {
        // The result in parts, in order: single nodes at the top, and whole subtrees.
        std::vector<Part> parts;
        std::vector<Subtree> pending{wholeTree(tree_)};
        while (!pending.empty()) {
            const Subtree next = pending.back();
            pending.pop_back();
            Part& part = parts.emplace_back(Part{next, {}});
            if (next.size() > kTaskNodes) appendNode(next, part.nodes, pending);
        }
        tbb::parallel_for(size_t(0), parts.size(), [&](size_t i) {
            if (parts[i].nodes.empty()) parts[i].nodes = collapseSubtree(parts[i].subtree);
        });
        std::vector<WideNode> all;
        for (const Part& part : parts)
            all.insert(all.end(), part.nodes.begin(), part.nodes.end());
        return all;
    }

  private:
    struct Part {
        Subtree subtree;
        std::vector<WideNode> nodes;
    };

    std::vector<WideNode> collapseSubtree(Subtree subtree) const {
        std::vector<WideNode> nodes;
        std::vector<Subtree> pending{subtree};
        while (!pending.empty()) {
            const Subtree next = pending.back();
            pending.pop_back();
            appendNode(next, nodes, pending);
        }
        return nodes;
    }

    /// Appends the wide node for the subtree's root, and to `pending` its inner children, the one
    /// in the first slot last.
    void appendNode(Subtree subtree, std::vector<WideNode>& nodes,
                    std::vector<Subtree>& pending) const {
        const SubtreeGroup group = plan_.childrenOf(subtree);
        std::array<Bounds, gpu::WIDE_CHILDREN> bounds;
        for (uint32_t i = 0; i < group.count; ++i)
            bounds[i] = tree_.nodes[group.subtree[i].first].bounds;
        const auto slots = assignSlots({bounds.data(), group.count});
        WideNode node;
        std::array<Subtree, gpu::WIDE_CHILDREN> bySlot{};
        for (uint32_t i = 0; i < group.count; ++i) {
            const uint32_t slot = slots[i], child = group.subtree[i].first;
            bySlot[slot] = group.subtree[i];
            node.child[slot] = child;
            (tree_.nodes[child].isLeaf() ? node.leaves : node.nodes) |= uint8_t(1u << slot);
        }
        for (uint32_t slot = gpu::WIDE_CHILDREN; slot-- > 0;)
            if (node.isNode(slot)) pending.push_back(bySlot[slot]);
        nodes.push_back(node);
    }

    const BinaryTree& tree_;
    CollapsePlan plan_;
};

} // namespace

std::vector<WideNode> collapse(const BinaryTree& tree) {
    if (tree.nodes.size() > 1) return Collapse(tree).run();
    WideNode root;
    root.leaves = tree.nodes.empty() ? 0 : 1;
    return {root};
}

} // namespace stromboli::bvh
