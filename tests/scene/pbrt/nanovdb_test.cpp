// Grids of NanoVDB files.
#include "scene/build/read_file.hpp"
#include "scene/pbrt/nanovdb.hpp"
#include "source_dir.h"
#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cstring>
#include <random>
#include <string>

namespace stromboli::test {
namespace {

using pbrt::readNanoGrid;
using testing::HasSubstr;

const std::string kCube = STROMBOLI_SOURCE_DIR "/tests/scene/pbrt/cube.nvdb";

/// Made by NanoVDB 32.4 (GridBuilder, packed by zlib): voxels of half a metre, the first one's
/// middle at (1, 2, 3); 1 + (x + 3) + 10 y + 100 (z - 2) for x from -3 to 8, y from 0 to 4 and z
/// from 2 to 3, and 7 at (20, 0, 2). Another grid has temperatures, 1000 + 100 (x + 3).
std::string nanoFile() {
    return build::readFile(kCube);
}

double voxel(const DensityGrid& grid, const glm::dvec3& number) {
    return grid.at(grid.place(0.5 * number + glm::dvec3(1, 2, 3)));
}

TEST(NanoGrids, HaveTheValuesOfTheirVoxels) {
    const auto read = readNanoGrid(nanoFile(), "cube.nvdb", "density", 1 << 20);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->voxelsOfCell, 1u);
    EXPECT_EQ(read->grid.size, glm::uvec3(26, 7, 4)); // a layer around
    for (int z = 2; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = -3; x < 9; ++x)
                EXPECT_NEAR(voxel(read->grid, {x, y, z}), 1 + (x + 3) + 10 * y + 100 * (z - 2),
                            1e-6);
    EXPECT_NEAR(voxel(read->grid, {20, 0, 2}), 7, 1e-6);
    // Between voxels linearly, and to nothing where there is none.
    EXPECT_NEAR(voxel(read->grid, {19.5, 0, 2}), 3.5, 1e-6);
    EXPECT_NEAR(voxel(read->grid, {-3.5, 0, 2}), 0.5, 1e-6);
    EXPECT_NEAR(voxel(read->grid, {15, 2, 2}), 0, 1e-6);
    EXPECT_FALSE(readNanoGrid(nanoFile(), "cube.nvdb", "flames", 1 << 20).has_value());
    const auto hot = readNanoGrid(nanoFile(), "cube.nvdb", "temperature", 1 << 20);
    EXPECT_NEAR(voxel(hot->grid, {4, 2, 3}), 1700, 1e-3);
}

TEST(NanoGrids, OfMoreCellsThanMayBeHaveMeans) {
    const auto read = readNanoGrid(nanoFile(), "cube.nvdb", "density", 200);
    EXPECT_EQ(read->voxelsOfCell, 4u);
    double sum = 0, cells = 0;
    for (const float value : read->grid.values)
        sum += double(value);
    for (int z = 2; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = -3; x < 9; ++x)
                cells += 1 + (x + 3) + 10 * y + 100 * (z - 2);
    EXPECT_NEAR(sum * 64, cells + 7, 1e-3) << "nothing is lost";
}

/// What the header of the file, which is not packed, says is changed.
TEST(NanoGrids, DamagedFilesAreRefused) {
    const std::string good = nanoFile();
    const auto refusal = [](const std::string& bytes) -> std::string {
        try {
            static_cast<void>(readNanoGrid(bytes, "a.nvdb", "density", 1 << 20));
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refusal("VDB"), HasSubstr("is no NanoVDB file"));
    for (size_t length = 8; length < good.size() / 2; length += 37) // the first grid
        EXPECT_THAT(refusal(good.substr(0, length)), HasSubstr("a.nvdb: ")) << length;
    std::string blosc = good;
    blosc[14] = 2;
    EXPECT_THAT(refusal(blosc), HasSubstr("packed by Blosc"));
    for (const uint32_t format : {31u, 33u}) {
        std::string other = good;
        const uint32_t version = format << 21 | 4u << 10;
        std::memcpy(other.data() + 8, &version, sizeof version);
        EXPECT_THAT(refusal(other), HasSubstr(fmt::format("is of format {} of", format)));
    }
    std::string damaged = good;
    damaged[400] = char(damaged[400] + 1);
    EXPECT_THAT(refusal(damaged), HasSubstr("damaged"));
    std::string huge = good;
    huge[16 + 7] = 1; // the size of the grid
    EXPECT_THAT(refusal(huge), HasSubstr("damaged"));
}

/// The file as it is without packing, with the densities alone.
std::string rawFile() {
    const std::string packed = nanoFile();
    const uint64_t one = 16 + 176 + sizeof "density", grid = one + 176 + sizeof "temperature";
    std::string raw = packed.substr(0, one);
    uLongf length = 0;
    std::memcpy(&length, packed.data() + 16, sizeof length);
    EXPECT_LT(length, 1u << 20);
    std::string bytes(length, '\0');
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                         reinterpret_cast<const Bytef*>(packed.data() + grid + 8),
                         packed.size() - grid - 8),
              Z_OK);
    raw[12] = 1, raw[14] = 0;
    std::memcpy(raw.data() + 16 + 8, &length, sizeof length);
    return raw + bytes;
}

TEST(NanoGrids, NeedNotBePacked) {
    const std::string raw = rawFile();
    const auto read = readNanoGrid(raw, "a.nvdb", "density", 1 << 20);
    EXPECT_EQ(read->grid.values, readNanoGrid(nanoFile(), "b", "density", 1 << 20)->grid.values);
    // Newer files may be the grid alone.
    std::string alone = raw.substr(16 + 176 + sizeof "density");
    alone[7] = '1';
    EXPECT_EQ(readNanoGrid(alone, "a", "density", 1 << 20)->grid.values, read->grid.values);
    alone[19] = char(33 << 5 >> 8), alone[18] = char(33 << 5); // its own version
    EXPECT_THROW(readNanoGrid(alone, "a", "density", 1 << 20), SceneError);
}

/// Whatever stands in a file, it is read or refused, and never beyond its end.
TEST(NanoGrids, MutatedFilesAreReadOrRefused) {
    const std::string good = rawFile();
    const uint64_t grid = 16 + 176 + sizeof "density";
    std::mt19937 random(1);
    int read = 0;
    for (int i = 0; i < 300; ++i) {
        std::string bytes = good;
        for (int change = 0; change < 4; ++change) {
            // Headers, and the first words of the nodes.
            constexpr uint64_t kNodes[] = {0, 672, 800, 800 + 270400, 800 + 270400 + 33856};
            const uint64_t place = grid + kNodes[random() % 5] + random() % 64;
            bytes[place] = char(random());
        }
        try {
            read += readNanoGrid(bytes, "a.nvdb", "density", 1 << 16).has_value();
        } catch (const SceneError& error) {
            EXPECT_THAT(error.what(), HasSubstr("a.nvdb: "));
        }
    }
    EXPECT_GT(read, 10);
}

TEST(NanoGrids, AreMediaOfPbrt) {
    const Scene scene =
        loadV4("Translate 10 0 0 MakeNamedMedium \"smoke\" \"string type\" \"nanovdb\" \"string "
               "filename\" "
               "\"" +
               kCube +
               "\" \"rgb sigma_s\" [2 2 2] \"float scale\" 3 MediumInterface \"smoke\" \"\" "
               "Material \"interface\" Shape \"sphere\"");
    const Medium& m = scene.media.at(0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(m.scattering[c], 6, 1e-4);
        EXPECT_NEAR(m.absorption[c], 3, 1e-4);
    }
    ASSERT_TRUE(m.density.has_value());
    const DensityGrid& grid = *m.density;
    EXPECT_NEAR(grid.at(grid.place(0.5 * glm::dvec3(20, 0, 2) + glm::dvec3(11, 2, 3))), 7, 1e-5);
}

TEST(NanoGrids, GlowByTheirTemperatures) {
    const Scene scene = loadV4(
        "MakeNamedMedium \"fire\" \"string type\" \"nanovdb\" \"string filename\" \"" + kCube +
        "\" \"float Lescale\" 2 \"float temperaturecutoff\" 500 \"float temperaturescale\" 3 "
        "MediumInterface \"fire\" \"\" Material \"interface\" Shape \"sphere\"");
    const Medium& m = scene.media.at(0);
    ASSERT_TRUE(m.colors.source.has_value());
    const glm::dvec3 at = m.colors.source->at(
        m.colors.source->place(0.5 * glm::dvec3(4, 2, 3) + glm::dvec3(1, 2, 3)));
    EXPECT_NEAR(at.x, 2 * 106.856895, 1e-4); // the integral of the CIE's curve of luminance
    EXPECT_NEAR(at.y, 3 * (1700 - 500), 1e-2);
    EXPECT_TRUE(m.colors.glow.has_value());
}

} // namespace
} // namespace stromboli::test
