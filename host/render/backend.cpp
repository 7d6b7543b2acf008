#include "host/render/backend.hpp"

#include <stdexcept>

namespace stromboli {

void Backend::beginAt(uint32_t) {
    throw std::logic_error("this backend takes samples from the first on only");
}

void Backend::restoreBlocks(std::span<const ExactStatistics> blocks) {
    if (!blocks.empty()) throw std::invalid_argument("the saved film is one of blocks");
}

std::vector<PixelSums> Backend::save(const Film& film) {
    std::vector<PixelSums> sums;
    sums.reserve(film.pixels.size());
    for (const PixelStatistics& p : film.pixels)
        sums.push_back({.count = p.count,
                        .rejected = p.rejected,
                        .firstRejected = p.firstRejected,
                        .first = p.mean,
                        .second = p.m2});
    return sums;
}

void Backend::restore(std::span<const PixelSums> sums, Film& film) {
    if (sums.size() != film.pixels.size())
        throw std::invalid_argument("the saved film is not of this picture");
    for (size_t i = 0; i < sums.size(); ++i)
        film.pixels[i] = {sums[i].count, sums[i].rejected, sums[i].firstRejected, sums[i].first,
                          sums[i].second};
}

} // namespace stromboli
