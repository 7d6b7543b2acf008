#include "host/bvh/binary_tree.hpp"

#include "host/bvh/binned_split.hpp"
#include "host/bvh/build_input.hpp"
#include "host/bvh/run_partition.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <memory>

namespace stromboli {

namespace {

using namespace bvh;

/// Runs at least this long become tasks of their own.
constexpr size_t kTaskRun = 1u << 12;

/// A node where it is built. A subtree over n primitives has at most 2n - 1 nodes, so it gets a
/// run of 2n - 1 slots: the node, the left subtree's slots, the right subtree's. Tasks need no
/// agreement on who takes which slot, and slots are in depth-first order from the start.
struct Slot {
    Float4 lo, hi;
    uint32_t right;        ///< inner: slot of the right child; the left one is the next slot
    uint32_t first, count; ///< leaf, or count = 0
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
        tree.order.resize(references_.size());
        tbb::parallel_for(tbb::blocked_range<size_t>(0, references_.size()), [&](const auto& r) {
            for (size_t i = r.begin(); i != r.end(); ++i)
                tree.order[i] = references_[i].primitive;
        });
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
            slot.first = job.first;
            slot.count = 0;
            Partition parts;
            if (!split(job, parts)) {
                slot.count = job.count;
                return;
            }
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

    /// Parts the job's run in two; false: it is to be a leaf.
    ///
    /// Depth stays within the cap. Let M be the largest leaf size and L(n) = ceil(log2(ceil(n/M))),
    /// that is, the least k with n <= M 2^k. Every job satisfies depth + L(count) <= cap:
    /// - The root does: checkBuild refuses other input.
    /// - SAH (and middle) splits happen only where depth + L(count) < cap. A child has fewer
    ///   primitives and L does not decrease, so depth + 1 + L(child) <= cap.
    /// - Where depth + L(count) = cap and L(count) >= 1, the run is halved at the median: from
    ///   count <= M 2^L follows ceil(count / 2) <= M 2^(L-1), M 2^(L-1) being an integer. So
    ///   L(child) <= L - 1, and depth + 1 + L(child) <= cap.
    /// - Where depth + L(count) = cap and L(count) = 0, count <= M: it becomes a leaf.
    bool split(const Job& job, Partition& parts) {
        const bool fitsLeaf = job.count <= options_.maxLeafSize;
        const std::span<BuildReference> run(references_.data() + job.first, job.count);
        if (job.depth + levelsNeeded(job.count, options_.maxLeafSize) >= options_.depthCap) {
            if (fitsLeaf) return false;
            parts = partitionAtMedian(run, job.bounds.centroids);
            return true;
        }
        if (job.count == 1) return false;
        const BinMapping mapping(job.bounds.centroids, binsFor(job.count, options_.bins));
        const BinnedSplit best = findBinnedSplit(run, mapping);
        if (fitsLeaf && (!best.found() || leafIsCheaper(job, best))) return false;
        parts = best.found() ? partitionByBin(run, mapping, best) : partitionInTheMiddle(run);
        return true;
    }

    bool leafIsCheaper(const Job& job, const BinnedSplit& best) const {
        const double area = job.bounds.box.halfArea();
        return area * job.count * options_.intersectionCost <=
               area * options_.traversalCost + best.cost * options_.intersectionCost;
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
            tree.nodes.push_back({Box4{slot.lo, slot.hi}.bounds(), 0, 0, slot.first, slot.count});
            tree.depth = std::max(tree.depth, next.depth);
            if (next.parent != kNone) tree.nodes[next.parent].right = index;
            if (slot.count == 0) {
                tree.nodes[index].left = index + 1;
                tree.nodes[index].first = 0;
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

BinaryTree buildBinaryTree(std::span<const Bounds> primitives, const BuildOptions& options) {
    checkBuild(primitives.size(), options);
    if (primitives.empty()) {
        BinaryTree tree;
        tree.nodes.emplace_back();
        return tree;
    }
    return TreeBuilder(readBounds(primitives), options).build();
}

} // namespace stromboli
