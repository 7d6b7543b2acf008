#include "host/bvh/binned_split.hpp"

#include "host/core/error.hpp"
#include "shaders/shared/scene_types.h"

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

namespace stromboli::bvh {

// --- The builder's input -------------------------------------------------------------------------

namespace {

constexpr uint32_t kMostBins = 64;
/// The builder recurses once per level; trees need a fraction of this.
constexpr uint32_t kMostDepth = 256;

void require(bool valid, const char* option, double value, const char* expected) {
    if (!valid)
        throw UsageError(fmt::format("BVH: {} is {}, expected {}", option, value, expected));
}

/// False for NaN too.
bool isUsable(const Bounds& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(-gpu::LARGEST_COORDINATE <= b.lo[axis] && b.lo[axis] <= b.hi[axis] &&
              b.hi[axis] <= gpu::LARGEST_COORDINATE))
            return false;
    return true;
}

BuildReference makeReference(const Bounds& b, size_t item) {
    return {{b.lo.x, b.lo.y, b.lo.z}, uint32_t(item), {b.hi.x, b.hi.y, b.hi.z}, 0};
}

/// What reading a part of the items gave.
struct PartRead {
    RunBounds bounds;
    size_t firstUnusable = std::numeric_limits<size_t>::max();
};

} // namespace

void checkBuild(size_t items, const BuildOptions& options) {
    require(options.bins >= 2 && options.bins <= kMostBins, "the number of bins", options.bins,
            "2 to 64");
    require(options.depthCap <= kMostDepth, "the depth cap", options.depthCap, "0 to 256");
    if (items > gpu::MAX_RECORDS)
        throw SceneError(
            fmt::format("BVH: {} leaves, expected at most {}", items, gpu::MAX_RECORDS));
    if (items > 0 && levelsNeeded(items) > options.depthCap)
        throw UsageError(fmt::format("BVH: {} leaves need a depth of {}, the cap is {}", items,
                                     levelsNeeded(items), options.depthCap));
}

BuildInput readBounds(std::span<const Bounds> items) {
    BuildInput input;
    input.references.resize(items.size());
    using Range = tbb::blocked_range<size_t>;
    constexpr size_t kGrain = 1u << 14;
    const PartRead all = tbb::parallel_reduce(
        Range(0, items.size(), kGrain), PartRead{},
        [&](const Range& range, PartRead part) {
            for (size_t i = range.begin(); i != range.end(); ++i) {
                input.references[i] = makeReference(items[i], i);
                part.bounds.extend(input.references[i].box());
                if (!isUsable(items[i])) part.firstUnusable = std::min(part.firstUnusable, i);
            }
            return part;
        },
        [](PartRead a, const PartRead& b) {
            a.bounds.extend(b.bounds);
            a.firstUnusable = std::min(a.firstUnusable, b.firstUnusable);
            return a;
        });
    if (all.firstUnusable < items.size())
        throw SceneError(fmt::format("BVH: leaf {} has no usable bounds, expected finite "
                                     "coordinates within +-2^60",
                                     all.firstUnusable));
    input.bounds = all.bounds;
    return input;
}

uint32_t levelsNeeded(size_t n) {
    return uint32_t(std::bit_width(n - 1));
}

// --- Choosing a split ----------------------------------------------------------------------------

namespace {

constexpr uint32_t kMaxBins = 64;
/// Runs longer than this are binned by several threads: below, a task costs more than it saves.
constexpr size_t kParallelRun = 1u << 16;
constexpr size_t kGrain = 1u << 14;

/// Boxes and counts of the bins of all three axes. Only the first `used` bins of an axis are ever
/// touched.
class Bins {
  public:
    explicit Bins(uint32_t used) : used_(used) {
        const Box4 empty;
        for (uint32_t axis = 0; axis < 3; ++axis) {
            std::fill_n(lo_[axis], used, empty.lo);
            std::fill_n(hi_[axis], used, empty.hi);
            std::fill_n(count_[axis], used, 0u);
        }
    }

    void add(std::span<const BuildReference> run, const BinMapping& mapping) {
        for (const BuildReference& reference : run) {
            const Box4 box = reference.box();
            const Int4 bin = mapping(doubledCentroid(box));
            for (int axis = 0; axis < 3; ++axis)
                add(axis, bin[axis], box, 1);
        }
    }

    void add(const Bins& other) {
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < int(used_); ++i)
                add(axis, i, other.box(axis, i), other.count_[axis][i]);
    }

    /// Lets `best` take over a better split of this axis, if there is one. n: number of
    /// items in all bins.
    void improve(BinnedSplit& best, uint32_t& bestImbalance, int axis, uint32_t n) const {
        std::array<float, kMaxBins> areaFrom; // half area of the bins from i on
        Box4 right;
        for (uint32_t i = used_ - 1; i > 0; --i) {
            right.extend(box(axis, int(i)));
            areaFrom[i] = right.halfArea();
        }
        Box4 left;
        uint32_t leftCount = 0;
        for (uint32_t i = 1; i < used_; ++i) {
            left.extend(box(axis, int(i) - 1));
            leftCount += count_[axis][i - 1];
            if (leftCount == 0 || count_[axis][i - 1] == 0) continue; // the same split as before
            if (leftCount == n) return;
            const uint32_t rightCount = n - leftCount;
            // Double: an area can be 2^124, and times a count leave the range of float.
            const double cost =
                double(left.halfArea()) * leftCount + double(areaFrom[i]) * rightCount;
            const uint32_t imbalance = std::max(leftCount, rightCount);
            if (cost < best.cost || (cost == best.cost && imbalance < bestImbalance)) {
                best = {cost, uint32_t(axis), i};
                bestImbalance = imbalance;
            }
        }
    }

  private:
    Box4 box(int axis, int i) const { return {lo_[axis][i], hi_[axis][i]}; }
    void add(int axis, int i, const Box4& box, uint32_t count) {
        lo_[axis][i] = minimum(lo_[axis][i], box.lo);
        hi_[axis][i] = maximum(hi_[axis][i], box.hi);
        count_[axis][i] += count;
    }

    uint32_t used_;
    // One array for each kind; left uninitialised, since short runs use few of the bins.
    Float4 lo_[3][kMaxBins];
    Float4 hi_[3][kMaxBins];
    uint32_t count_[3][kMaxBins];
};

BinnedSplit bestSplit(const Bins& bins, size_t n) {
    BinnedSplit best{std::numeric_limits<double>::infinity(), 0, 0};
    uint32_t imbalance = 0;
    for (int axis = 0; axis < 3; ++axis)
        bins.improve(best, imbalance, axis, uint32_t(n));
    return best;
}

} // namespace

BinMapping::BinMapping(const Box4& centroids, uint32_t bins)
    : bins_(bins), origin_(centroids.lo), last_(splat(float(bins - 1))) {
    const Float4 extent = centroids.hi - centroids.lo;
    for (int axis = 0; axis < 4; ++axis) {
        // An extent of 0, or one whose reciprocal overflows, leaves the axis in bin 0.
        const float scale = extent[axis] > 0 ? float(bins) / extent[axis] : 0.0f;
        scale_[axis] = scale <= std::numeric_limits<float>::max() ? scale : 0.0f;
    }
}

uint32_t binsFor(size_t n, uint32_t mostBins) {
    return uint32_t(std::min<size_t>(mostBins, 4 + n / 2));
}

BinnedSplit findBinnedSplit(std::span<const BuildReference> run, const BinMapping& mapping) {
    if (run.size() <= kParallelRun) {
        Bins bins(mapping.bins());
        bins.add(run, mapping);
        return bestSplit(bins, run.size());
    }
    using Range = tbb::blocked_range<size_t>;
    const Bins bins = tbb::parallel_reduce(
        Range(0, run.size(), kGrain), Bins(mapping.bins()),
        [&](const Range& r, Bins partial) {
            partial.add(run.subspan(r.begin(), r.size()), mapping);
            return partial;
        },
        [](Bins a, const Bins& b) {
            a.add(b);
            return a;
        });
    return bestSplit(bins, run.size());
}

// --- Carrying it out -----------------------------------------------------------------------------

namespace {

RunBounds boundsOf(std::span<const BuildReference> run) {
    RunBounds bounds;
    for (const BuildReference& reference : run)
        bounds.extend(reference.box());
    return bounds;
}

int widestAxis(const Box4& box) {
    const Float4 extent = box.hi - box.lo;
    int widest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (extent[axis] > extent[widest]) widest = axis;
    return widest;
}

} // namespace

Partition partitionByBin(std::span<BuildReference> run, const BinMapping& mapping,
                         const BinnedSplit& split) {
    Partition result;
    const int axis = int(split.axis), firstRightBin = int(split.bin);
    const auto goesLeft = [&](const Box4& box) {
        return mapping(doubledCentroid(box))[axis] < firstRightBin;
    };
    size_t begin = 0, end = run.size(); // of the part not yet looked at
    while (begin < end) {
        const Box4 box = run[begin].box();
        if (goesLeft(box)) {
            result.left.extend(box);
            ++begin;
            continue;
        }
        result.right.extend(box);
        // The place at the end is for this one; what is there and belongs left comes here.
        while (--end > begin) {
            const Box4 other = run[end].box();
            if (goesLeft(other)) {
                result.left.extend(other);
                std::swap(run[begin++], run[end]);
                break;
            }
            result.right.extend(other);
        }
    }
    result.leftCount = begin;
    return result;
}

Partition partitionAtMedian(std::span<BuildReference> run, const Box4& centroids) {
    const int axis = widestAxis(centroids);
    const auto before = [axis](const BuildReference& a, const BuildReference& b) {
        const float x = a.lo[axis] + a.hi[axis], y = b.lo[axis] + b.hi[axis];
        return x != y ? x < y : a.item < b.item;
    };
    const auto middle = run.begin() + std::ptrdiff_t((run.size() + 1) / 2);
    std::nth_element(run.begin(), middle, run.end(), before);
    return partitionInTheMiddle(run);
}

Partition partitionInTheMiddle(std::span<const BuildReference> run) {
    const size_t leftCount = (run.size() + 1) / 2;
    return {leftCount, boundsOf(run.first(leftCount)), boundsOf(run.subspan(leftCount))};
}

} // namespace stromboli::bvh
