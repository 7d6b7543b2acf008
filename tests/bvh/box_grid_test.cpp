// No decoded box is ever inside the true one: the margin holds on hard intervals, exactly.

#include "host/bvh/node_record.hpp"
#include "host/core/random.hpp"
#include "shaders/shared/scene_types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stromboli::test {
namespace {

using namespace bvh;

struct Interval {
    float low, high;
};

/// Intervals of the children of one node: sizes and distances from 0 over all of float's range,
/// many without extent, many that share ends.
std::vector<Interval> hardChildren(Random& random) {
    const float size = std::ldexp(1.0f, int(random.below(180)) - 120);
    float origin = 0;
    switch (random.below(4)) {
    case 0: // about 0
        break;
    case 1: // floats lie farther apart than cells
        origin = size * std::ldexp(random.uniform(-1, 1), int(random.below(26)));
        break;
    default:
        origin = size * random.uniform(-4, 4);
    }
    std::vector<Interval> children;
    for (uint32_t n = 1 + random.below(8); n > 0; --n) {
        const float a = origin + size * random.uniform();
        const float b = random.below(3) ? origin + size * random.uniform() : a;
        children.push_back({std::min(a, b), std::max(a, b)});
        if (random.below(4) == 0) children.push_back({origin, origin});
    }
    return children;
}

/// In long double, which has the bits for these sums.
long double decoded(const AxisGrid& grid, uint32_t plane) {
    return (long double)grid.origin + plane * std::ldexp(1.0L, int(grid.exponent) - 127);
}

struct Violations {
    int ofMargin = 0, ofRange = 0;
};

template <class Below, class Above>
Violations countViolations(const std::vector<Interval>& children, Below below, Above above) {
    Interval all = children[0];
    for (const Interval& c : children)
        all = {std::min(all.low, c.low), std::max(all.high, c.high)};
    const AxisGrid grid = AxisGrid::fromWord(gridOver(all.low, all.high).word());
    const long double margin = gpu::BOX_MARGIN * std::ldexp(1.0L, int(grid.exponent) - 127);
    Violations violations;
    for (const Interval& c : children) {
        const uint32_t low = below(grid, c.low), high = above(grid, c.high);
        violations.ofRange += low > 255 || high > 255 || grid.exponent < 1 || grid.exponent > 254;
        violations.ofMargin += decoded(grid, low) > c.low - margin;
        violations.ofMargin += decoded(grid, high) < c.high + margin;
    }
    return violations;
}

uint32_t nearestPlane(const AxisGrid& grid, double x) {
    return uint32_t(std::lround((x - double(grid.origin)) / grid.cell()));
}

TEST(BoxGrid, EveryIntervalLiesInsideItsPlanesByTheMargin) {
    Random random(30);
    int ofNearest = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto children = hardChildren(random);
        const Violations v = countViolations(children, planeBelow, planeAbove);
        ASSERT_EQ(v.ofMargin, 0) << i;
        ASSERT_EQ(v.ofRange, 0) << i;
        ofNearest += countViolations(children, nearestPlane, nearestPlane).ofMargin;
    }
    EXPECT_GT(ofNearest, 100000) << "rounding to the nearest plane should not do";
}

TEST(BoxGrid, IsAsFineAsCanBe) {
    // The next finer power of two would leave no room: twice its 255 cells are more than needed.
    Random random(31);
    for (int i = 0; i < 10000; ++i) {
        const float low = random.uniform(-1, 1) * 1e-3f;
        const float high = low + std::ldexp(1.0f + random.uniform(), int(random.below(40)) - 20);
        const AxisGrid grid = gridOver(low, high);
        const double extent = double(high) - low;
        EXPECT_GE(planeAbove(grid, high), 126u);
        EXPECT_LT(extent, 255 * grid.cell());
    }
}

TEST(BoxGrid, CellsKeepProductsNormal) {
    for (const double size : {0.0, 1e-45, 1e-38, 1e-30})
        EXPECT_EQ(gridOver(0, size).cell(), 0x1p-90) << size;
}

} // namespace
} // namespace stromboli::test
