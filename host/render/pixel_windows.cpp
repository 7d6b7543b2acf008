#include "host/render/pixel_windows.hpp"

#include <algorithm>

namespace stromboli {

PixelWindows::PixelWindows(const Film& film, std::span<const glm::dvec3> values, int64_t first)
    : film_(film), values_(values) {
    rows_.fill(std::vector<PixelGroup>(film.width));
    for (int64_t y = std::max<int64_t>(first - kReach, 0); y < first + kReach; ++y)
        sumRow(y);
}

std::vector<PixelGroup> PixelWindows::of(int64_t y) {
    sumRow(y + kReach);
    std::vector<PixelGroup> sums = besides(y);
    for (int64_t j = std::max<int64_t>(y - kReach, 0); j <= y + kReach; ++j)
        for (size_t x = 0; j != y && x < sums.size(); ++x)
            sums[x] += rows_[size_t(j) % rows_.size()][x];
    return sums;
}

PixelGroup PixelWindows::alone(int64_t x, int64_t y) const {
    const size_t pixel = size_t(y) * film_.width + size_t(x);
    const PixelStatistics& p = film_.pixels[pixel];
    if (p.count < 2) return {};
    return {values_[pixel], p.mean, 1};
}

/// Neighbours in the same row.
std::vector<PixelGroup> PixelWindows::besides(int64_t y) const {
    std::vector<PixelGroup> sums(film_.width);
    for (int64_t x = 0; x < int64_t(film_.width); ++x) {
        const int64_t right = std::min<int64_t>(x + kReach, int64_t(film_.width) - 1);
        for (int64_t i = std::max<int64_t>(x - kReach, 0); i <= right; ++i)
            if (i != x) sums[size_t(x)] += alone(i, y);
    }
    return sums;
}

void PixelWindows::sumRow(int64_t y) {
    std::vector<PixelGroup>& row = rows_[size_t(y) % rows_.size()];
    std::fill(row.begin(), row.end(), PixelGroup{});
    if (y >= int64_t(film_.height)) return;
    for (int64_t x = 0; x < int64_t(film_.width); ++x) {
        const PixelGroup own = alone(x, y);
        const int64_t right = std::min<int64_t>(x + kReach, int64_t(film_.width) - 1);
        for (int64_t i = std::max<int64_t>(x - kReach, 0); i <= right; ++i)
            row[size_t(i)] += own;
    }
}

} // namespace stromboli
