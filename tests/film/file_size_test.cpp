// How large a picture's file can be, known before it is rendered.
#include "host/film/image_file.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

namespace stromboli {
namespace {

/// Noise in all the bits of its floats, which no compression makes smaller.
Film noise(uint32_t width, uint32_t height) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> value(0, 1);
    Film film(width, height);
    for (PixelStatistics& p : film.pixels)
        for (int i = 0; i < 3; ++i)
            p.add({value(random), value(random), value(random)});
    return film;
}

TEST(LargestPictureFile, IsKeptByNoiseAndNearIt) {
    const TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair(1u, 1u), {300u, 200u}, {1u, 4000u}, {4000u, 1u}})
        for (const bool statistics : {false, true})
            for (const char* name : {"a.png", "a.exr"}) {
                writePicture(folder / name, noise(width, height),
                             {.tone = {}, .statistics = statistics});
                const uint64_t bytes = std::filesystem::file_size(folder / name);
                const uint64_t most =
                    largestPictureFile(folder / name, width, height, {{}, statistics});
                EXPECT_LE(bytes, most) << name << " " << width << " x " << height;
                // Sample counts and high bits compress: a bound of twice the file is no mistake.
                EXPECT_LE(most, 2 * bytes + 4096 + 32 * height) << name << " " << width;
            }
}

} // namespace
} // namespace stromboli
