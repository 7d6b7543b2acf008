#include "host/bvh/run_partition.hpp"

#include <algorithm>
#include <utility>

namespace stromboli::bvh {

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
