// What the kernel reads of an environment: radiance to 18 bits, and an alias table whose
// probabilities are those of the weights.
#include "host/kernel/sampling_tables.hpp"

#include "host/core/color.hpp"
#include "host/core/random.hpp"

#include <glm/gtx/component_wise.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

TEST(EnvironmentTable, RadianceIsKeptTo18BitsOfItsLargestComponent) {
    Random random(1);
    for (int i = 0; i < 100000; ++i) {
        const glm::vec3 radiance = std::exp2(random.uniform(-100, 100)) *
                                   glm::vec3(random.uniform(0, 1), random.uniform(0, 1), 1);
        gpu::EnvironmentTexel texel{};
        encodeRadiance(radiance, texel);
        // Half a unit of the last bit; the largest mantissa may be cut by as much again.
        const float bound = glm::compMax(radiance) * 0x1p-17f;
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(decodeRadiance(texel)[c], radiance[c], bound) << radiance.z;
    }
}

TEST(EnvironmentTable, EndsOfTheRange) {
    gpu::EnvironmentTexel texel{};
    for (const float value : {0.0f, 1.0f, 0x1p-110f, 3.4e38f, 0x1p127f}) {
        encodeRadiance({value, 0, value / 2}, texel);
        EXPECT_NEAR(decodeRadiance(texel).x, value, value * 0x1p-17f);
        EXPECT_EQ(decodeRadiance(texel).y, 0);
        EXPECT_NEAR(decodeRadiance(texel).z, value / 2, value * 0x1p-17f);
    }
    encodeRadiance(glm::vec3(1e-44f), texel); // too small to be kept, but no other value
    EXPECT_LE(decodeRadiance(texel).x, 1e-38f);
}

Environment noise(uint32_t width, uint32_t height) {
    Environment e;
    e.width = width;
    e.height = height;
    Random random(7);
    e.radiance.clear();
    for (uint32_t i = 0; i < width * height; ++i)
        e.radiance.push_back(random.uniform(0, 1) < 0.2f
                                 ? glm::vec3(0)
                                 : std::pow(10.0f, random.uniform(-3, 3)) * glm::vec3(1, 2, 3));
    return e;
}

class RowsOfEnvironment : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(EnvironmentTable, RowsOfEnvironment, ::testing::Bool(),
                         [](const auto& rows) {
                             return std::string(rows.param ? "ReachThePoles" : "AreHalfARowAway");
                         });

TEST_P(RowsOfEnvironment, TexelsArePickedByTheirWeight) {
    Environment e = noise(16, 8);
    e.rowsReachPoles = GetParam();
    const EnvironmentTable table = packEnvironment(e);
    std::vector<double> weights, probability(128);
    double sum = 0;
    constexpr double kPi = 3.14159265358979;
    for (uint32_t y = 0; y < 8; ++y) {
        // Of a row at a pole half is there, and its sine on the mean is that of its middle.
        double weight = e.rowsReachPoles ? std::sin(kPi * y / 7) : std::sin(kPi * (y + 0.5) / 8);
        if (e.rowsReachPoles && (y == 0 || y == 7)) weight = 0.5 * std::sin(kPi * 0.25 / 7);
        for (uint32_t x = 0; x < 16; ++x)
            sum += weights.emplace_back(luminance(e.radiance[y * 16 + x]) * weight);
    }
    // Each texel is a tile here: texels are picked as tiles are.
    ASSERT_EQ(table.light.tiles, 128u);
    for (uint32_t i = 0; i < 128; ++i) {
        const auto columns = structureAt<gpu::TileColumns>(*table.texels, i / 2);
        const double own = i % 2 == 0 ? columns.threshold0 : columns.threshold1;
        probability[i] += own / 128;
        probability[i % 2 == 0 ? columns.alias0 : columns.alias1] += (1 - own) / 128;
    }
    for (uint32_t i = 0; i < 128; ++i)
        EXPECT_NEAR(probability[i], weights[i] / sum, 1e-6) << i;
    const double rows = e.rowsReachPoles ? 7 : 8;
    EXPECT_NEAR(table.luminance, sum * 2 * kPi * kPi / (16 * rows), 1e-4 * table.luminance);
}

/// Directions to the middles of texels, and, of rows at a pole, a little beside it.
TEST_P(RowsOfEnvironment, TilesLieInTheirDirections) {
    Environment e = noise(16, 8);
    e.rowsReachPoles = GetParam();
    e.rotation = 0.4f;
    const EnvironmentTable table = packEnvironment(e);
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 16; ++x) {
            const double share = e.rowsReachPoles ? y / 7.0 : (y + 0.5) / 8;
            const double polar = std::clamp(3.14159265358979 * share, 0.01, 3.13);
            const double azimuth = 2 * 3.14159265358979 * (x + 0.5) / 16 - e.rotation;
            const glm::vec3 w(-std::sin(polar) * std::sin(azimuth), std::cos(polar),
                              std::sin(polar) * std::cos(azimuth));
            EXPECT_EQ(tileOf(table, w), y * 16 + x);
        }
}

/// Of a picture whose last tiles are cut off by its edges.
TEST(EnvironmentTable, TexelsOfATileArePickedByTheirWeight) {
    const uint32_t width = 150, height = 70;
    const Environment e = noise(width, height);
    const EnvironmentTable table = packEnvironment(e);
    EXPECT_EQ(table.light.tileShift, 3u);
    EXPECT_EQ(table.light.tilesAcross, 19u);
    ASSERT_EQ(table.light.tiles, 19u * 9u);
    std::vector<double> weights(width * height), probability(width * height), ofTile(19 * 9);
    double sum = 0;
    const auto tileAt = [](uint32_t x, uint32_t y) { return y / 8 * 19 + x / 8; };
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            weights[y * width + x] = luminance(e.radiance[y * width + x]) *
                                     std::sin(3.14159265358979 * (y + 0.5) / height);
            sum += weights[y * width + x];
            ofTile[tileAt(x, y)] += weights[y * width + x];
        }
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t texels =
                std::min(8u, width - x / 8 * 8) * std::min(8u, height - y / 8 * 8);
            const auto texel = structureAt<gpu::EnvironmentTexel>(
                *table.texels, gpu::ENVIRONMENT_COLUMN_ROWS + y * width + x);
            probability[y * width + x] += double(texel.threshold) / texels;
            probability[texel.alias] += (1 - double(texel.threshold)) / texels;
            ASSERT_EQ(tileAt(texel.alias % width, texel.alias / width), tileAt(x, y));
        }
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t i = y * width + x;
            ASSERT_NEAR(probability[i], weights[i] / ofTile[tileAt(x, y)], 4e-6) << x << " " << y;
        }
    for (uint32_t t = 0; t < table.light.tiles; ++t)
        EXPECT_NEAR(table.tileProbability[t], ofTile[t] / sum, 1e-5);
}

TEST(EnvironmentTable, SaysHowUnevenItIs) {
    Environment e{"", 64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(3)), 2, 0};
    EXPECT_NEAR(packEnvironment(e).unevenness, 1, 1e-4);
    // All light comes from one texel: the sphere over its solid angle.
    e.radiance.assign(e.radiance.size(), glm::vec3(0));
    e.radiance[10 * 64 + 5] = glm::vec3(7);
    const double pi = std::acos(-1.0);
    const double texel = std::sin(pi * 10.5 / 32) * (2 * pi / 64) * (pi / 32);
    EXPECT_NEAR(packEnvironment(e).unevenness, 4 * pi / texel, 1e-3 * 4 * pi / texel);
}

TEST(EnvironmentTable, ABlackOneHasNoTexels) {
    Environment e = noise(4, 2);
    e.radiance.assign(8, glm::vec3(0));
    EXPECT_EQ(packEnvironment(e).texels, nullptr);
}

TEST(EnvironmentTable, OneThatIsTurnedSharesItsTexels) {
    Environment e{"", 4, 2, std::vector<glm::vec3>(8, glm::vec3(1)), 1, 0};
    const EnvironmentTable table = packEnvironment(e), other = turned(table, 0.5f);
    e.rotation = 0.5f;
    EXPECT_EQ(other.texels, table.texels);
    EXPECT_EQ(other.light.sinRotation, packEnvironment(e).light.sinRotation);
    EXPECT_EQ(other.light.cosRotation, packEnvironment(e).light.cosRotation);
    EXPECT_EQ(other.light.density, table.light.density);
}

} // namespace
} // namespace stromboli::test
