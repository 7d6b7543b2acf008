#pragma once

#include "host/bvh/binned_split.hpp"
#include "host/bvh/box4.hpp"

#include <cstddef>
#include <span>

namespace stromboli::bvh {

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
