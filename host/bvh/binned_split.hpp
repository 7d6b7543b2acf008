#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/box4.hpp"

#include <cstdint>
#include <span>

namespace stromboli::bvh {

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

} // namespace stromboli::bvh
