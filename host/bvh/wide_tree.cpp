#include "host/bvh/wide_tree.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace stromboli::bvh {

// --- Which nodes stay ----------------------------------------------------------------------------

namespace {

constexpr uint32_t kMost = gpu::WIDE_CHILDREN;
constexpr uint32_t kNodesPerPlanTask = 1u << 14;

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

CollapsePlan::CollapsePlan(const BinaryTree& tree) : tree_(tree), entries_(tree.nodes.size()) {
    const float rootArea = tree.nodes.front().bounds.halfArea();
    inverseRootArea_ = rootArea > 0 ? 1 / rootArea : 0;
    // Children follow their parents.
    const CutTree parts = cut(tree, kNodesPerPlanTask);
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

} // namespace

// --- Slots of children ---------------------------------------------------------------------------

namespace {

constexpr uint32_t kSlots = gpu::WIDE_CHILDREN;
constexpr uint32_t kSets = 1u << kSlots;

/// All sets of slots, smaller ones first.
struct SetsBySize {
    std::array<uint8_t, kSets> set{};
    std::array<uint32_t, kSlots + 2> start{}; ///< by size; one more at the end

    constexpr SetsBySize() {
        uint32_t next = 0;
        for (uint32_t size = 0; size <= kSlots; ++size) {
            start[size] = next;
            for (uint32_t s = 0; s < kSets; ++s)
                if (uint32_t(std::popcount(s)) == size) set[next++] = uint8_t(s);
        }
        start[kSlots + 1] = next;
    }
};
constexpr SetsBySize kSetsBySize;

/// How well a child fits into each slot.
std::array<double, kSlots> gains(const Bounds& child, const glm::dvec3& doubledMiddle) {
    const glm::dvec3 offset = glm::dvec3(child.lo) + glm::dvec3(child.hi) - doubledMiddle;
    // Not 0 for boxes without area, so that their order counts where there are only those.
    const double weight = std::max(double(child.halfArea()), std::numeric_limits<double>::min());
    std::array<double, kSlots> gain;
    for (uint32_t slot = 0; slot < kSlots; ++slot)
        gain[slot] =
            weight * ((slot & 1 ? offset.x : -offset.x) + (slot & 2 ? offset.y : -offset.y) +
                      (slot & 4 ? offset.z : -offset.z));
    return gain;
}

} // namespace

std::array<uint8_t, kSlots> assignSlots(std::span<const Bounds> children) {
    Bounds all;
    for (const Bounds& b : children)
        all.extend(b);
    const glm::dvec3 doubledMiddle = glm::dvec3(all.lo) + glm::dvec3(all.hi);
    // By set of slots: the greatest gain of the first children in them, and the last one's slot.
    std::array<double, kSets> best;
    std::array<uint8_t, kSets> lastSlot;
    best[0] = 0;
    for (uint32_t child = 0; child < children.size(); ++child) {
        const auto gain = gains(children[child], doubledMiddle);
        for (uint32_t i = kSetsBySize.start[child + 1]; i < kSetsBySize.start[child + 2]; ++i) {
            const uint32_t set = kSetsBySize.set[i];
            // Without branches, of which a processor would guess every third one wrongly.
            double greatest = -std::numeric_limits<double>::infinity();
            uint32_t last = 0;
            for (uint32_t rest = set; rest != 0; rest &= rest - 1) {
                const uint32_t slot = uint32_t(std::countr_zero(rest));
                const double total = best[set ^ 1u << slot] + gain[slot];
                const uint32_t isGreater = total > greatest ? ~0u : 0u;
                last = (slot & isGreater) | (last & ~isGreater);
                greatest = std::max(greatest, total);
            }
            best[set] = greatest;
            lastSlot[set] = uint8_t(last);
        }
    }
    const auto sets = kSetsBySize.set.begin();
    uint32_t set = *std::max_element(sets + kSetsBySize.start[children.size()],
                                     sets + kSetsBySize.start[children.size() + 1],
                                     [&](uint8_t a, uint8_t b) { return best[a] < best[b]; });
    std::array<uint8_t, kSlots> slots{};
    for (size_t child = children.size(); child-- > 0;) {
        slots[child] = lastSlot[set];
        set ^= 1u << lastSlot[set];
    }
    return slots;
}

// --- The wide tree -------------------------------------------------------------------------------

namespace {

constexpr uint32_t kNodesPerCollapseTask = 1u << 13; // of the binary tree

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
            if (next.size() > kNodesPerCollapseTask) appendNode(next, part.nodes, pending);
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
