#pragma once

#include "host/bvh/binary_tree.hpp"
#include "scene/model/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace stromboli::bvh {

// --- Boxes in registers --------------------------------------------------------------------------

/// Four floats in one register (GCC and Clang vector extension): a corner of a box, whose fourth
/// lane is 0. One instruction then does what glm::vec3 needs three for, and the builder does
/// little else than take minima and maxima.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

/// The lesser of two values by lane; where they are equal (zeros of either sign), the second. This
/// is associative, so that reductions that keep the order, as TBB's do, are the same to the bit
/// however they are divided.
inline Float4 minimum(Float4 a, Float4 b) {
    return a < b ? a : b;
}
inline Float4 maximum(Float4 a, Float4 b) {
    return a > b ? a : b;
}
inline Float4 splat(float x) {
    return Float4{x, x, x, x};
}

/// Axis-aligned box; the default one is empty.
struct Box4 {
    Float4 lo = splat(3.402823466e38f);
    Float4 hi = splat(-3.402823466e38f);

    void extend(Float4 p) { lo = minimum(lo, p), hi = maximum(hi, p); }
    void extend(const Box4& b) { lo = minimum(lo, b.lo), hi = maximum(hi, b.hi); }
    /// Half the surface area. The box must not be empty. Coordinates within 2^60 cannot
    /// overflow.
    float halfArea() const {
        const Float4 e = hi - lo;
        return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
    }
    Bounds bounds() const { return Bounds{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

/// What the builder moves around: an item's box and its number, 32 bytes, so that a node's
/// items are always one contiguous run of memory.
struct alignas(16) BuildReference {
    float lo[3];
    uint32_t item;
    float hi[3];
    uint32_t unused;

    Box4 box() const {
        // The lane of the item's number is cleared: read as a float it is denormal, and
        // adding denormals is slow.
        constexpr Int4 kXyz{-1, -1, -1, 0};
        Int4 l, h;
        std::memcpy(&l, lo, sizeof l);
        std::memcpy(&h, hi, sizeof h);
        return {reinterpret_cast<Float4>(l & kXyz), reinterpret_cast<Float4>(h & kXyz)};
    }
};

/// Twice the centre of a box: what is compared and binned; the factor does not matter.
inline Float4 doubledCentroid(const Box4& b) {
    return b.lo + b.hi;
}

/// What a node knows of its run of items.
struct RunBounds {
    Box4 box;
    Box4 centroids; ///< of the doubled centroids

    void extend(const Box4& b) {
        box.extend(b);
        centroids.extend(doubledCentroid(b));
    }
    void extend(const RunBounds& r) {
        box.extend(r.box);
        centroids.extend(r.centroids);
    }
};

// --- The builder's input -------------------------------------------------------------------------

/// Throws UsageError where the options are outside the ranges BuildOptions states, or where so
/// many items cannot be had within the depth cap; SceneError where there are more items than
/// records.
void checkBuild(size_t items, const BuildOptions& options);

/// The builder's copy of the items' boxes, in order, and their common bounds.
struct BuildInput {
    std::vector<BuildReference> references;
    RunBounds bounds;
};

/// Throws SceneError naming the first item whose box is inverted, not finite, or beyond
/// gpu::LARGEST_COORDINATE.
BuildInput readBounds(std::span<const Bounds> items);

/// The fewest levels below a node that n >= 1 items need: ceil(log2(n)).
uint32_t levelsNeeded(size_t n);

// --- Choosing a split ----------------------------------------------------------------------------

/// Maps centroids to bins, the same for finding the split and for carrying it out.
class BinMapping {
  public:
    BinMapping(const Box4& centroids, uint32_t bins);

    uint32_t bins() const { return bins_; }
    /// Bin of a doubled centroid on each axis. The centroid must lie in the mapping's box.
    Int4 operator()(Float4 centroid) const {
        return __builtin_convertvector(minimum((centroid - origin_) * scale_, last_), Int4);
    }

  private:
    uint32_t bins_;
    Float4 origin_, scale_, last_;
};

/// The best way to part a run in two: bins below `bin` on `axis` go left.
struct BinnedSplit {
    double cost = 0;   ///< sum of half area times number of items over both children
    uint32_t axis = 0; ///< 0..2
    uint32_t bin = 0;  ///< 0: no split puts items on both sides
    bool found() const { return bin != 0; }
};

/// Bins for a run of n items: options.bins for long runs; short ones make do with fewer, as
/// most of their bins would stay empty.
uint32_t binsFor(size_t n, uint32_t mostBins);

/// Least SAH cost over all three axes and all bin boundaries; equal costs (boxes without area)
/// go to the more even split. Finds a split whenever the centroids differ on an axis by more
/// than the reciprocal of the largest float. Long runs are binned in parallel; the result does
/// not depend on how, since minima, maxima and counts are exact.
BinnedSplit findBinnedSplit(std::span<const BuildReference> run, const BinMapping& mapping);

// --- Carrying it out -----------------------------------------------------------------------------

/// A run parted in two: its first leftCount items go left. Neither part is empty.
struct Partition {
    size_t leftCount = 0;
    RunBounds left, right;
};

/// Carries out a binned split, in place; collects the bounds of both parts on the way.
Partition partitionByBin(std::span<BuildReference> run, const BinMapping& mapping,
                         const BinnedSplit& split);

/// Half of the items (rounded up) to each side, by centroid on the axis where `centroids`
/// is widest, equal ones by item number. At least two items.
Partition partitionAtMedian(std::span<BuildReference> run, const Box4& centroids);

/// Half of the items (rounded up) to each side, in the order they are in.
Partition partitionInTheMiddle(std::span<const BuildReference> run);

} // namespace stromboli::bvh
