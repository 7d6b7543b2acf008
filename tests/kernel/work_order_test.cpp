// The order in which lanes take pixels.
#include "host/kernel/dispatcher.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stromboli {
namespace {

/// Targets for every n-th pixel, as an adaptive pass leaves them; the sample number names the
/// pixel.
std::vector<PixelTarget> everyNth(uint32_t n, uint32_t pixels) {
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < pixels; i += n)
        targets.push_back({i, i + 1});
    return targets;
}

uint32_t tileOf(const PixelTarget& t, uint32_t width) {
    return t.pixel / width / 8 * 1000 + t.pixel % width / 8;
}

TEST(WorkOrder, TakesTileAfterTileInReadingOrder) {
    for (const uint32_t width : {64u, 61u, 1u, 300u})
        for (const uint32_t n : {1u, 7u}) {
            const auto order = tileOrder(everyNth(n, width * 37), width);
            for (size_t i = 1; i < order.size(); ++i) {
                const uint32_t before = tileOf(order[i - 1], width), now = tileOf(order[i], width);
                ASSERT_LE(before, now) << width << ' ' << i;
                // Row by row within a tile: eight side by side are a row.
                ASSERT_TRUE(before < now || order[i - 1].pixel < order[i].pixel) << i;
            }
        }
}

TEST(WorkOrder, KeepsEveryTarget) {
    const auto targets = everyNth(3, 100 * 60);
    auto order = tileOrder(targets, 100);
    std::ranges::sort(order, {}, &PixelTarget::pixel);
    ASSERT_EQ(order.size(), targets.size());
    for (size_t i = 0; i < order.size(); ++i) {
        EXPECT_EQ(order[i].pixel, targets[i].pixel);
        EXPECT_EQ(order[i].samples, targets[i].samples);
    }
    EXPECT_TRUE(tileOrder({}, 100).empty());
}

} // namespace
} // namespace stromboli
