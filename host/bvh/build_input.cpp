#include "host/bvh/build_input.hpp"

#include "host/core/error.hpp"
#include "shaders/shared/scene_types.h"

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace stromboli::bvh {

namespace {

constexpr uint32_t kMostBins = 64;
/// The builder recurses once per level; trees need a fraction of this.
constexpr uint32_t kMostDepth = 256;
constexpr size_t kMostPrimitives = size_t(gpu::CHILD_FIRST_MASK) + 1;

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

BuildReference makeReference(const Bounds& b, size_t primitive) {
    return {{b.lo.x, b.lo.y, b.lo.z}, uint32_t(primitive), {b.hi.x, b.hi.y, b.hi.z}, 0};
}

/// What reading a part of the primitives gave.
struct PartRead {
    RunBounds bounds;
    size_t firstUnusable = std::numeric_limits<size_t>::max();
};

} // namespace

void checkBuild(size_t primitives, const BuildOptions& options) {
    require(options.maxLeafSize >= 1 && options.maxLeafSize <= gpu::MAX_LEAF_PRIMITIVES,
            "the largest leaf size", options.maxLeafSize, "1 to 16");
    require(options.bins >= 2 && options.bins <= kMostBins, "the number of bins", options.bins,
            "2 to 64");
    require(std::isfinite(options.traversalCost) && options.traversalCost >= 0,
            "the traversal cost", options.traversalCost, "a finite number, at least 0");
    require(std::isfinite(options.intersectionCost) && options.intersectionCost > 0,
            "the intersection cost", options.intersectionCost, "a finite number above 0");
    require(options.depthCap <= kMostDepth, "the depth cap", options.depthCap, "0 to 256");
    if (primitives > kMostPrimitives)
        throw SceneError(
            fmt::format("BVH: {} primitives, expected at most {}", primitives, kMostPrimitives));
    if (primitives > 0 && levelsNeeded(primitives, options.maxLeafSize) > options.depthCap)
        throw UsageError(fmt::format(
            "BVH: {} primitives in leaves of at most {} need a depth of {}, the cap is {}",
            primitives, options.maxLeafSize, levelsNeeded(primitives, options.maxLeafSize),
            options.depthCap));
}

BuildInput readBounds(std::span<const Bounds> primitives) {
    BuildInput input;
    input.references.resize(primitives.size());
    using Range = tbb::blocked_range<size_t>;
    constexpr size_t kGrain = 1u << 14;
    const PartRead all = tbb::parallel_reduce(
        Range(0, primitives.size(), kGrain), PartRead{},
        [&](const Range& range, PartRead part) {
            for (size_t i = range.begin(); i != range.end(); ++i) {
                input.references[i] = makeReference(primitives[i], i);
                part.bounds.extend(input.references[i].box());
                if (!isUsable(primitives[i])) part.firstUnusable = std::min(part.firstUnusable, i);
            }
            return part;
        },
        [](PartRead a, const PartRead& b) {
            a.bounds.extend(b.bounds);
            a.firstUnusable = std::min(a.firstUnusable, b.firstUnusable);
            return a;
        });
    if (all.firstUnusable < primitives.size())
        throw SceneError(fmt::format("BVH: primitive {} has no usable bounds, expected finite "
                                     "coordinates within +-2^60",
                                     all.firstUnusable));
    input.bounds = all.bounds;
    return input;
}

uint32_t levelsNeeded(size_t n, uint32_t maxLeafSize) {
    const size_t leaves = (n + maxLeafSize - 1) / maxLeafSize;
    return uint32_t(std::bit_width(leaves - 1));
}

} // namespace stromboli::bvh
