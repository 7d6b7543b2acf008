#include "host/kernel/work_order.hpp"

#include <algorithm>

namespace stromboli {

std::vector<PixelTarget> tileOrder(std::span<const PixelTarget> targets, uint32_t width) {
    constexpr uint32_t kTile = 8; // pixels: one row of a tile fills the lanes of an AVX2 register
    const auto tileOf = [&](const PixelTarget& t) {
        const uint32_t tilesAcross = (width + kTile - 1) / kTile;
        return uint64_t(t.pixel / width / kTile) * tilesAcross + t.pixel % width / kTile;
    };
    std::vector<PixelTarget> order(targets.begin(), targets.end());
    std::stable_sort(order.begin(), order.end(), [&](const PixelTarget& a, const PixelTarget& b) {
        return tileOf(a) < tileOf(b);
    });
    return order;
}

} // namespace stromboli
