// Light samples to an environment (shaders/lights/environment.glsl) by way of light.comp.
#include "tests/shaders/light_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace stromboli::test {
namespace {

class EnvironmentSampling : public LightFixture {};

/// A tile that is taken in one of 5e7 samples is chosen by the last digits of a random number: what
/// chooses its texels has to be filled anew.
TEST_F(EnvironmentSampling, ReachesAllTexelsOfADimTile) {
    constexpr uint32_t kWidth = 1024, kHeight = 512, kSide = 32; // texels of a tile
    Environment e;
    e.width = kWidth, e.height = kHeight;
    e.radiance.assign(size_t(kWidth) * kHeight, glm::vec3(1));
    e.radiance[size_t(kWidth) * (kHeight / 2)] = glm::vec3(5e10f); // in the first tile of its row
    Scene scene = sceneWithEmitter(glm::vec3(0), true);
    scene.environment = e;
    setScene(scene);
    const uint32_t column = 5 * 32 + 9; // of tiles: a dim one
    std::vector<gpu::LightQuery> queries = samples(surfaceAt({0, 0, 0}, {0, 0, 1}), 200000, 31);
    for (gpu::LightQuery& q : queries)
        q.u = float(column) / 512;
    std::set<std::pair<uint32_t, uint32_t>> texels;
    size_t inTile = 0;
    for (const gpu::LightAnswer& a : answers(queries)) {
        const glm::dvec3 w(a.direction);
        const double x = (std::atan2(w.x, -w.z) / (2 * M_PI) + 0.5) * kWidth,
                     y = std::acos(w.y) / M_PI * kHeight;
        if (x < 9 * kSide || x >= 10 * kSide || y < 5 * kSide || y >= 6 * kSide) continue;
        ++inTile;
        texels.emplace(uint32_t(x), uint32_t(y));
    }
    EXPECT_GT(inTile, 20000u);
    EXPECT_GT(texels.size(), 1000u); // of 1024
}

} // namespace
} // namespace stromboli::test
