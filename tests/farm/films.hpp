#pragma once

#include "host/farm/film_file.hpp"
#include "host/farm/round_plan.hpp"
#include "tests/render/drawn_samples.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stromboli::test {

/// Films of a picture of drawn samples, kSide pixels on a side.
inline FilmHeader pictureOf(uint32_t samples, uint32_t perBlock) {
    FilmHeader header;
    header.identity = {"0.1.0", "12345678", "room.dae", 42, "vulkan", "a device"};
    header.settings = settingsOf(samples);
    header.settings.budget.samplesPerBlock = perBlock;
    header.scene = "room.dae";
    header.command = {"stromboli render", "room.dae", "--even"};
    return header;
}

inline std::vector<PixelTarget> allPixels(const PictureArea& area, uint32_t samples) {
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < area.pixelCount(); ++i)
        targets.push_back({i, samples});
    return targets;
}

/// The sums of a film of the first round, drawn.
inline std::vector<SharedPixel> drawBlocks(const FilmHeader& header, const Draw& draw,
                                           uint32_t seed) {
    if (header.isEmpty()) return {};
    const PictureArea& area = header.settings.area;
    const SampleBlocks all = header.allBlocks();
    std::vector<SharedPixel> sums(area.pixelCount());
    DrawnBackend backend(draw, seed);
    for (const BlockRange& range : header.blocks)
        for (uint32_t block = range.first; block < range.end; ++block) {
            Film film(area);
            const uint32_t first = all.firstOf(block);
            backend.beginAt(first);
            backend.sample(allPixels(area, all.firstOf(block + 1) - first), film,
                           [](uint64_t) { return true; });
            for (size_t i = 0; i < sums.size(); ++i)
                sums[i].add(film.pixels[i], first, header.passOf(block));
        }
    return sums;
}

/// The sums of a share of a planned round, drawn: the samples' numbers go on from those before.
inline std::vector<SharedPixel> drawPlanned(const PlannedShare& share, const Draw& draw,
                                            uint32_t seed) {
    if (share.header.isEmpty()) return {};
    const PictureArea& area = share.header.settings.area;
    std::vector<SharedPixel> sums(area.pixelCount());
    DrawnBackend backend(draw, seed);
    for (const PlannedPixel& p : share.pixels) {
        PixelStatistics samples;
        for (uint32_t i = p.from; i < p.to; ++i)
            samples.add(backend.sampleAlone(p.pixel, i).radiance);
        sums[p.pixel].add(samples, p.from, share.header.rounds());
    }
    return sums;
}

inline void writeFilm(const std::filesystem::path& file, const FilmHeader& header,
                      std::span<const SharedPixel> pixels) {
    FilmWriter writer(file, header);
    writer.add(pixels);
    writer.finish();
}

} // namespace stromboli::test
