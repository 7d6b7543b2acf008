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

KeptPixels Backend::save(const Film& film, PixelRun run) {
    KeptPixels kept;
    kept.bytes.reserve(run.count * kept.bytesPerPixel());
    for (const PixelStatistics& p : std::span(film.pixels).subspan(run.first, run.count))
        kept.append(p);
    return kept;
}

void Backend::restore(PixelRun run, const KeptPixels& pixels, Film& film) {
    if (!pixels.sameKind({}) || pixels.count() != run.count ||
        uint64_t(run.first) + run.count > film.pixels.size())
        throw std::invalid_argument("the saved film is not of this picture");
    for (uint32_t i = 0; i < run.count; ++i)
        film.pixels[run.first + i] = pixels.statistics(i);
}

KeptPixels Backend::saveAll(const Film& film) {
    return save(film, {0, uint32_t(film.pixels.size())});
}

void Backend::restoreAll(const KeptPixels& pixels, Film& film) {
    restore({0, uint32_t(film.pixels.size())}, pixels, film);
}

} // namespace stromboli
