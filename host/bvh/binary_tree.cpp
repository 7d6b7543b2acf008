#include "host/bvh/binary_tree.hpp"

#include "host/bvh/binned_split.hpp"
#include "host/bvh/reinsertion.hpp"

#include <tbb/task_group.h>

#include <algorithm>
#include <memory>

namespace stromboli {

// --- The binary tree -----------------------------------------------------------------------------

namespace {

using namespace bvh;

/// Runs at least this long become tasks of their own.
constexpr size_t kTaskRun = 1u << 12;

/// A node where it is built. A subtree over n items has at most 2n - 1 nodes, so it gets a
/// run of 2n - 1 slots: the node, the left subtree's slots, the right subtree's. Tasks need no
/// agreement on who takes which slot, and slots are in depth-first order from the start.
struct Slot {
    Float4 lo, hi;
    uint32_t right; ///< inner: slot of the right child, the left one is the next slot; leaf: 0
    uint32_t item;  ///< leaf
};

/// A subtree still to be built.
struct Job {
    uint32_t slot;
    uint32_t first, count; ///< its run of references, count >= 1
    uint32_t depth;
    RunBounds bounds;
};

class TreeBuilder {
  public:
    TreeBuilder(BuildInput input, const BuildOptions& options)
        : options_(options), bounds_(input.bounds), references_(std::move(input.references)),
          slots_(std::make_unique_for_overwrite<Slot[]>(2 * references_.size() - 1)) {}

    BinaryTree build() {
        buildSubtree({0, 0, uint32_t(references_.size()), 0, bounds_});
        tasks_.wait();
        BinaryTree tree;
        compact(tree);
        return tree;
    }

  private:
    /// Goes down the left children itself and leaves long right ones to other threads.
    void buildSubtree(Job job) {
        for (;;) {
            Slot& slot = slots_[job.slot];
            slot.lo = job.bounds.box.lo;
            slot.hi = job.bounds.box.hi;
            slot.right = 0;
            if (job.count == 1) {
                slot.item = references_[job.first].item;
                return;
            }
            const Partition parts = split(job);
            const uint32_t leftCount = uint32_t(parts.leftCount);
            slot.right = job.slot + 2 * leftCount;
            const Job right{slot.right, job.first + leftCount, job.count - leftCount, job.depth + 1,
                            parts.right};
            if (right.count >= kTaskRun)
                tasks_.run([this, right] { buildSubtree(right); });
            else
                buildSubtree(right);
            job = {job.slot + 1, job.first, leftCount, job.depth + 1, parts.left};
        }
    }

    /// Parts the job's run of two or more in two.
    ///
    /// Depth stays within the cap. Let L(n) = ceil(log2(n)), the least k with n <= 2^k. Every job
    /// satisfies depth + L(count) <= cap:
    /// - The root does: checkBuild refuses other input.
    /// - SAH (and middle) splits happen only where depth + L(count) < cap. A child has fewer
    ///   items and L does not decrease, so depth + 1 + L(child) <= cap.
    /// - Where depth + L(count) = cap, the run is halved at the median: from count <= 2^L follows
    ///   ceil(count / 2) <= 2^(L-1). So L(child) <= L - 1, and depth + 1 + L(child) <= cap.
    Partition split(const Job& job) {
        const std::span<BuildReference> run(references_.data() + job.first, job.count);
        if (job.depth + levelsNeeded(job.count) >= options_.depthCap)
            return partitionAtMedian(run, job.bounds.centroids);
        if (job.count == 2) return partitionInTheMiddle(run);
        const BinMapping mapping(job.bounds.centroids, binsFor(job.count, options_.bins));
        const BinnedSplit best = findBinnedSplit(run, mapping);
        return best.found() ? partitionByBin(run, mapping, best) : partitionInTheMiddle(run);
    }

    /// Copies the slots in use, depth first.
    void compact(BinaryTree& tree) const {
        struct Pending {
            uint32_t slot;
            uint32_t parent; ///< whose right child it is, or kNone
            uint32_t depth;
        };
        constexpr uint32_t kNone = 0xFFFFFFFFu;
        tree.nodes.reserve(2 * references_.size() - 1);
        std::vector<Pending> rightChildren;
        Pending next{0, kNone, 0};
        for (;;) {
            const Slot& slot = slots_[next.slot];
            const uint32_t index = uint32_t(tree.nodes.size());
            tree.nodes.push_back({Box4{slot.lo, slot.hi}.bounds(), slot.item, 0});
            tree.depth = std::max(tree.depth, next.depth);
            if (next.parent != kNone) tree.nodes[next.parent].right = index;
            if (slot.right != 0) {
                tree.nodes[index].left = index + 1;
                rightChildren.push_back({slot.right, index, next.depth + 1});
                next = {next.slot + 1, kNone, next.depth + 1};
            } else {
                if (rightChildren.empty()) return;
                next = rightChildren.back();
                rightChildren.pop_back();
            }
        }
    }

    BuildOptions options_;
    RunBounds bounds_;
    std::vector<BuildReference> references_;
    std::unique_ptr<Slot[]> slots_;
    tbb::task_group tasks_;
};

} // namespace

BinaryTree buildBinaryTree(std::span<const Bounds> items, const BuildOptions& options) {
    checkBuild(items.size(), options);
    if (items.empty()) return {};
    BinaryTree tree = TreeBuilder(readBounds(items), options).build();
    if (options.reinsert) reinsertSubtrees(tree, options.depthCap);
    return tree;
}

} // namespace stromboli

namespace stromboli::bvh {

// --- Subtrees ------------------------------------------------------------------------------------

CutTree cut(const BinaryTree& tree, uint32_t mostNodes) {
    CutTree result;
    std::vector<Subtree> pending{wholeTree(tree)};
    while (!pending.empty()) {
        const Subtree next = pending.back();
        pending.pop_back();
        if (next.size() <= mostNodes) {
            result.subtrees.push_back(next);
            continue;
        }
        result.above.push_back(next.first);
        pending.push_back(rightOf(tree, next));
        pending.push_back(leftOf(tree, next));
    }
    return result;
}

} // namespace stromboli::bvh
