#include "host/render/backend.hpp"

#include <stdexcept>

namespace stromboli {

void Backend::beginAt(uint32_t) {
    throw std::logic_error("this backend takes samples from the first on only");
}

std::vector<SampleValue> Backend::samplesAlone(uint32_t pixel, uint32_t first, uint32_t count) {
    std::vector<SampleValue> values;
    values.reserve(count);
    for (uint32_t i = 0; i < count; ++i)
        values.push_back(sampleAlone(pixel, first + i));
    return values;
}

void Backend::restoreBlocks(std::span<const ExactStatistics> blocks) {
    if (!blocks.empty()) throw std::invalid_argument("the saved film is one of blocks");
}

std::vector<PixelSums> Backend::save(const Film& film, PixelRun run) {
    std::vector<PixelSums> sums;
    sums.reserve(run.count);
    for (const PixelStatistics& p : std::span(film.pixels).subspan(run.first, run.count))
        sums.push_back({.count = p.count,
                        .rejected = p.rejected,
                        .firstRejected = p.firstRejected,
                        .first = p.mean,
                        .second = p.m2});
    return sums;
}

void Backend::restore(PixelRun run, std::span<const PixelSums> sums, Film& film) {
    if (sums.size() != run.count || uint64_t(run.first) + run.count > film.pixels.size())
        throw std::invalid_argument("the saved film is not of this picture");
    for (size_t i = 0; i < sums.size(); ++i)
        film.pixels[run.first + i] = {sums[i].count, sums[i].rejected, sums[i].firstRejected,
                                      sums[i].first, sums[i].second};
}

std::vector<PixelSums> Backend::saveAll(const Film& film) {
    return save(film, {0, uint32_t(film.pixels.size())});
}

void Backend::restoreAll(std::span<const PixelSums> sums, Film& film) {
    restore({0, uint32_t(film.pixels.size())}, sums, film);
}

} // namespace stromboli
