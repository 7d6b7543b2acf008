#include "host/bvh/build_input.hpp"

#include "host/core/error.hpp"
#include "shaders/shared/scene_types.h"

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace stromboli::bvh {

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

} // namespace stromboli::bvh
