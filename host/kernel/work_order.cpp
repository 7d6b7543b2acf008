#include "host/kernel/work_order.hpp"

#include <algorithm>
#include <numeric>

namespace stromboli {
namespace {

constexpr uint32_t kTile = 8; // pixels; 64 lanes of a workgroup

/// Visits 0..n-1 in strides near n / golden ratio: any run of visits is spread evenly.
uint64_t coprimeStride(uint64_t n) {
    auto stride = uint64_t(double(n) * 0.6180339887498949);
    stride = std::max<uint64_t>(stride, 1);
    while (std::gcd(stride, n) != 1)
        ++stride;
    return stride;
}

} // namespace

std::vector<PixelTarget> interleave(std::span<const PixelTarget> targets, uint32_t width) {
    const uint32_t tilesAcross = (width + kTile - 1) / kTile;
    const auto tileOf = [&](const PixelTarget& t) {
        return (t.pixel / width / kTile) * tilesAcross + t.pixel % width / kTile;
    };
    std::vector<PixelTarget> tiled(targets.begin(), targets.end());
    std::stable_sort(tiled.begin(), tiled.end(), [&](const PixelTarget& a, const PixelTarget& b) {
        return tileOf(a) < tileOf(b);
    });
    const uint64_t runs = (tiled.size() + kTile * kTile - 1) / (kTile * kTile);
    if (runs < 2) return tiled;
    const uint64_t stride = coprimeStride(runs);
    std::vector<PixelTarget> order;
    order.reserve(tiled.size());
    for (uint64_t i = 0; i < runs; ++i) {
        const size_t first = size_t(i * stride % runs) * kTile * kTile;
        const size_t last = std::min(first + kTile * kTile, tiled.size());
        order.insert(order.end(), tiled.begin() + ptrdiff_t(first),
                     tiled.begin() + ptrdiff_t(last));
    }
    return order;
}

} // namespace stromboli
