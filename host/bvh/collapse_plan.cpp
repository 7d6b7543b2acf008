#include "host/bvh/collapse_plan.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace stromboli::bvh {

namespace {

constexpr uint32_t kMost = gpu::WIDE_CHILDREN;
constexpr uint32_t kTaskNodes = 1u << 14;

} // namespace

CollapsePlan::CollapsePlan(const BinaryTree& tree) : tree_(tree), entries_(tree.nodes.size()) {
    const float rootArea = tree.nodes.front().bounds.halfArea();
    inverseRootArea_ = rootArea > 0 ? 1 / rootArea : 0;
    // Children follow their parents.
    const CutTree parts = cut(tree, kTaskNodes);
    tbb::parallel_for(size_t(0), parts.subtrees.size(), [&](size_t i) {
        for (uint32_t node = parts.subtrees[i].end; node-- > parts.subtrees[i].first;)
            plan(node);
    });
    for (size_t i = parts.above.size(); i-- > 0;)
        plan(parts.above[i]);
}

void CollapsePlan::plan(uint32_t index) {
    const BinaryNode& node = tree_.nodes[index];
    Entry& entry = entries_[index];
    const float area = node.bounds.halfArea() * inverseRootArea_;
    entry.choice = 0;
    if (node.isLeaf()) {
        std::fill_n(entry.cost, kMost - 1, area);
        return;
    }
    const Entry &left = entries_[node.left], &right = entries_[node.right];
    float apart[kMost + 1];     // by number of records: the cost without one for the node itself
    uint32_t toLeft[kMost + 1]; // and how many of them go to the left child
    for (uint32_t j = 2; j <= kMost; ++j) {
        apart[j] = left.cost[0] + right.cost[j - 2];
        toLeft[j] = 1;
        for (uint32_t k = 2; k < j; ++k) {
            const float cost = left.cost[k - 1] + right.cost[j - k - 1];
            if (cost < apart[j]) apart[j] = cost, toLeft[j] = k;
        }
    }
    entry.cost[0] = area + apart[kMost];
    for (uint32_t j = 2; j < kMost; ++j) {
        entry.cost[j - 1] = std::min(entry.cost[j - 2], apart[j]);
        if (apart[j] < entry.cost[j - 2]) entry.choose(j, toLeft[j]);
    }
    entry.choose(kMost, toLeft[kMost]);
}

SubtreeGroup CollapsePlan::childrenOf(Subtree subtree) const {
    struct Part {
        Subtree subtree;
        uint32_t records;
    };
    SubtreeGroup group;
    std::array<Part, kMost> pending; // right sides, each of which is given a record at least
    uint32_t pendingCount = 0;
    Part part{subtree, kMost};
    for (;;) {
        const Entry& entry = entries_[part.subtree.first];
        while (part.records > 1 && entry.choiceOf(part.records) == 0)
            --part.records;
        if (part.records > 1) {
            const uint32_t toLeft = entry.choiceOf(part.records);
            pending[pendingCount++] = {rightOf(tree_, part.subtree), part.records - toLeft};
            part = {leftOf(tree_, part.subtree), toLeft};
            continue;
        }
        group.subtree[group.count++] = part.subtree;
        if (pendingCount == 0) return group;
        part = pending[--pendingCount];
    }
}

} // namespace stromboli::bvh
