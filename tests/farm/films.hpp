#pragma once

#include "host/farm/film_file.hpp"
#include "host/render/block_backend.hpp"
#include "tests/render/drawn_samples.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace stromboli::test {

/// Of a picture of drawn samples, kSide pixels on a side.
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

/// The sums of a film's blocks, drawn.
inline std::vector<ExactStatistics> drawBlocks(const FilmHeader& header, const Draw& draw,
                                               uint32_t seed) {
    const PictureArea& area = header.settings.area;
    const SampleBlocks all = header.allBlocks();
    BlockSums sums;
    DrawnBackend backend(draw, seed);
    for (const BlockRange& range : header.blocks)
        for (uint32_t block = range.first; block < range.end; ++block) {
            Film film(area);
            const uint32_t first = all.firstOf(block);
            backend.beginAt(first);
            backend.sample(allPixels(area, all.firstOf(block + 1) - first), film,
                           [](uint64_t) { return true; });
            sums.add(film, first);
        }
    return sums.pixels();
}

inline void writeFilm(const std::filesystem::path& file, const FilmHeader& header,
                      std::span<const ExactStatistics> pixels) {
    FilmWriter writer(file, header);
    writer.add(pixels);
    writer.finish();
}

} // namespace stromboli::test
