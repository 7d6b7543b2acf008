// What is learnt of where light samples to an environment arrive (host/kernel/light_guide.hpp).
#include "host/kernel/light_guide.hpp"

#include "host/core/random.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <numeric>

namespace stromboli::test {
namespace {

Environment sky(uint32_t width, uint32_t height) {
    Environment e;
    e.width = width;
    e.height = height;
    Random random(3);
    e.radiance.clear();
    for (uint32_t i = 0; i < width * height; ++i)
        e.radiance.push_back(glm::vec3(random.uniform(0.1f, 1)));
    return e;
}

/// In the middle of a texel, by its weight.
glm::vec3 drawn(const Environment& e, const EnvironmentTable& table, Random& random) {
    for (;;) {
        const uint32_t x = random.below(e.width), y = random.below(e.height);
        const double azimuth = 2 * 3.14159265358979 * (x + 0.5) / e.width,
                     polar = 3.14159265358979 * (y + 0.5) / e.height;
        if (random.uniform() > e.radiance[y * e.width + x].x * std::sin(polar)) continue;
        const glm::vec3 w(-std::sin(polar) * std::sin(azimuth), std::cos(polar),
                          std::sin(polar) * std::cos(azimuth));
        EXPECT_EQ(tileOf(table, w) % table.light.tilesAcross, x >> table.light.tileShift);
        EXPECT_EQ(tileOf(table, w) / table.light.tilesAcross, y >> table.light.tileShift);
        return w;
    }
}

/// On the side x < 0 only light from w.z > 0.8 arrives, on the other only that from w.z < -0.8.
bool arrives(const glm::vec3& position, const glm::vec3& w) {
    return position.x < 0 ? w.z > 0.8f : w.z < -0.8f;
}

class LightGuideTest : public testing::Test {
  protected:
    Environment environment = sky(64, 32);
    EnvironmentTable table = packEnvironment(environment);

    std::vector<LightNote> notes(size_t count, bool someArrive = true) const {
        Random random(5);
        std::vector<LightNote> all(count);
        for (size_t i = 0; i < count; ++i) {
            LightNote& r = all[i];
            r.position = random.inCube(1);
            r.normal = glm::vec3(0, random.below(2) ? 1 : -1, 0);
            r.direction = drawn(environment, table, random);
            r.value = someArrive && arrives(r.position, r.direction) ? 1.0f : 0.0f;
            r.isOfOdd = i / 4 % 2 == 1;
        }
        return all;
    }

    /// The first row of the table of a point's cell, as the kernel finds it.
    static size_t tableAt(const LightGuide& guide, const glm::vec3& p, const glm::vec3& n) {
        const std::array<float, 6> at = {p.x, p.y, p.z, n.x, n.y, n.z};
        size_t node = 0;
        for (uint32_t level = 0; level < gpu::GUIDE_LEVELS; ++level) {
            const auto cuts = structureAt<gpu::GuideNode>(guide.rows, node);
            const bool above = at.at(cuts.axes & 0xFF) > cuts.cut;
            const uint32_t axis = (above ? cuts.axes >> 16 : cuts.axes >> 8) & 0xFF;
            const bool second = at.at(axis) > (above ? cuts.cutAbove : cuts.cutBelow);
            node = 4 * node + 1 + (above ? 2 : 0) + (second ? 1 : 0);
        }
        return gpu::GUIDE_NODES + (node - gpu::GUIDE_NODES) * gpu::GUIDE_TABLE_ROWS;
    }

    /// The probability of each tile, as the kernel states it.
    std::vector<double> stated(const LightGuide& guide, size_t first) const {
        std::vector<double> p;
        for (uint32_t t = 0; t < table.light.tiles; ++t)
            p.push_back(table.tileProbability[t] *
                        double(structureAt<gpu::TileRatios>(
                                   guide.rows, first + gpu::ENVIRONMENT_COLUMN_ROWS + t)
                                   .own));
        return p;
    }
};

TEST_F(LightGuideTest, TilesFromWhichLightArrivesAreTakenMoreOften) {
    const LightGuide guide = learnLightGuide(notes(60000), table);
    EXPECT_GT(guide.gain, 3);
    for (const glm::vec3& p : {glm::vec3(-0.5f, 0, 0), glm::vec3(0.5f, 0.3f, -0.2f)}) {
        const std::vector<double> probability = stated(guide, tableAt(guide, p, {0, 1, 0}));
        double seen = 0, seenByWeight = 0;
        for (uint32_t y = 0; y < environment.height; ++y)
            for (uint32_t x = 0; x < environment.width; ++x) {
                const double azimuth = 2 * 3.14159265358979 * (x + 0.5) / environment.width,
                             polar = 3.14159265358979 * (y + 0.5) / environment.height;
                const auto z = float(std::sin(polar) * std::cos(azimuth));
                if (!arrives(p, {0, 0, z})) continue;
                const uint32_t tile = (y >> table.light.tileShift) * table.light.tilesAcross +
                                      (x >> table.light.tileShift);
                seen += probability[tile];
                seenByWeight += table.tileProbability[tile];
            }
        EXPECT_GT(seen, 3 * seenByWeight);
    }
}

TEST_F(LightGuideTest, ProbabilitiesAreThoseOfTheColumns) {
    const LightGuide guide = learnLightGuide(notes(60000), table);
    ASSERT_EQ(guide.rows.size(),
              gpu::GUIDE_NODES + size_t(gpu::GUIDE_CELLS) * gpu::GUIDE_TABLE_ROWS);
    const uint32_t tiles = table.light.tiles, across = table.light.tilesAcross;
    for (const uint32_t cell : {0u, 100u, 255u}) {
        const size_t first = gpu::GUIDE_NODES + size_t(cell) * gpu::GUIDE_TABLE_ROWS;
        const std::vector<double> probability = stated(guide, first);
        EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0), 1, 1e-6);
        std::vector<double> picked(tiles);
        for (uint32_t t = 0; t < tiles; ++t) {
            const auto columns = structureAt<gpu::TileColumns>(guide.rows, first + t / 2);
            const double own = t % 2 == 0 ? columns.threshold0 : columns.threshold1;
            picked[t] += own / tiles;
            picked.at(t % 2 == 0 ? columns.alias0 : columns.alias1) += (1 - own) / tiles;
        }
        const auto ratios = [&](uint32_t t) {
            return structureAt<gpu::TileRatios>(guide.rows,
                                                first + gpu::ENVIRONMENT_COLUMN_ROWS + t);
        };
        for (uint32_t t = 0; t < tiles; ++t) {
            EXPECT_NEAR(picked[t], probability[t], 1e-7 * probability[t]);
            EXPECT_GE(ratios(t).own, LightGuide::kUnlearned * (1 - 1e-5));
            const uint32_t right = t % across + 1 == across ? t + 1 - across : t + 1;
            EXPECT_EQ(ratios(t).right, ratios(right).own);
            if (t + across < tiles) {
                EXPECT_EQ(ratios(t).below, ratios(t + across).own);
                EXPECT_EQ(ratios(t).across, ratios(right + across).own);
            }
        }
    }
}

TEST_F(LightGuideTest, WithoutLightTilesAreTakenByWeight) {
    const LightGuide guide = learnLightGuide(notes(20000, false), table);
    EXPECT_EQ(guide.gain, 1);
    const std::vector<double> probability = stated(guide, gpu::GUIDE_NODES);
    for (uint32_t t = 0; t < table.light.tiles; ++t)
        EXPECT_NEAR(probability[t], table.tileProbability[t], 1e-6 * probability[t]);
}

TEST_F(LightGuideTest, FewNotesTeachNothing) {
    const LightGuide guide = learnLightGuide(notes(4000), table);
    EXPECT_EQ(guide.gain, 1);
    EXPECT_TRUE(guide.rows.empty());
}

TEST_F(LightGuideTest, WhatIsNotFiniteIsLeftOut) {
    std::vector<LightNote> some = notes(20000);
    const LightGuide guide = learnLightGuide(some, table);
    const float nan = std::nanf("");
    for (int i = 0; i < 3; ++i)
        some.emplace_back();
    some[20000].direction = glm::vec3(nan, 0, 0);
    some[20001].position = glm::vec3(0, INFINITY, 0), some[20001].direction = glm::vec3(0, 1, 0);
    some[20002].normal = glm::vec3(nan), some[20002].direction = glm::vec3(0, 1, 0);
    EXPECT_EQ(learnLightGuide(some, table).rows, guide.rows);
}

TEST_F(LightGuideTest, IsTheSameForAnyNumberOfThreads) {
    const std::vector<LightNote> some = notes(30000);
    LightGuide one, two;
    tbb::task_arena(1).execute([&] { one = learnLightGuide(some, table); });
    tbb::task_arena(4).execute([&] { two = learnLightGuide(some, table); });
    EXPECT_EQ(one.gain, two.gain);
    EXPECT_EQ(one.rows, two.rows);
}

} // namespace
} // namespace stromboli::test
