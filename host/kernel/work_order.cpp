#include "host/kernel/work_order.hpp"

#include <numeric>

namespace stromboli {

std::vector<PixelTarget> tileOrder(std::span<const PixelTarget> targets, uint32_t width) {
    if (targets.empty()) return {};
    constexpr uint32_t kTile = 8; // pixels: one row of a tile fills the lanes of an AVX2 register
    const size_t tilesAcross = (width + kTile - 1) / kTile;
    const auto tileOf = [&](const PixelTarget& t) {
        return t.pixel / width / kTile * tilesAcross + t.pixel % width / kTile;
    };
    // Counting sort: targets are in row order, and so are those of a tile.
    std::vector<size_t> firstOf(tileOf(targets.back()) / tilesAcross * tilesAcross + tilesAcross +
                                1);
    for (const PixelTarget& t : targets)
        ++firstOf[tileOf(t) + 1];
    std::partial_sum(firstOf.begin(), firstOf.end(), firstOf.begin());
    std::vector<PixelTarget> order(targets.size());
    for (const PixelTarget& t : targets)
        order[firstOf[tileOf(t)]++] = t;
    return order;
}

} // namespace stromboli
