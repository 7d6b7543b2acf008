// gap_proposal.glsl: the density of bounces into the gap is the one that the points of the rims are
// sampled with. The mean of 1 / pdf over the samples in a region is the region's solid angle, which
// for a rectangle in the light's plane is known.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "tests/shaders/light_fixture.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/gap_proposal_texel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

using gpu::GapAnswer;
using gpu::GapQuery;

constexpr glm::dvec2 kSize(0.8, 0.5);
constexpr double kGap = 0.02;

/// An emitter in the plane y = 0, from (0, 0, 0) to (0.8, 0, 0.5), and a ceiling 0.02 above it; all
/// of it times `scale`, and turned upside down if `turned`.
Scene emitterUnderCeiling(float scale, bool turned) {
    Scene scene = sceneWithEmitter(glm::vec3(1), true);
    scene.materials[0].albedo = glm::vec3(0.5f);
    const auto place = [&](float x, float y, float z) {
        return scale * (turned ? glm::vec3(x, -y, -z) : glm::vec3(x, y, z));
    };
    const auto quad = [&](float x0, float x1, float y, float z0, float z1, uint32_t material) {
        addEmitterTriangle(scene, place(x0, y, z0), place(x1, y, z0), place(x1, y, z1));
        addEmitterTriangle(scene, place(x0, y, z0), place(x1, y, z1), place(x0, y, z1));
        scene.triangles[scene.triangles.size() - 1].material = material;
        scene.triangles[scene.triangles.size() - 2].material = material;
    };
    quad(0, float(kSize.x), 0, 0, float(kSize.y), 1);
    quad(-2, 2, float(kGap), -2, 2, 0);
    return scene;
}

/// Solid angle of the rectangle [low, high] of the plane at height 1 over the origin's foot (0, 0),
/// by the arc tangents of its corners.
double solidAngle(const glm::dvec2& low, const glm::dvec2& high, double height) {
    const auto corner = [height](double x, double y) {
        return std::atan2(x * y, height * std::sqrt(x * x + y * y + height * height));
    };
    return corner(high.x, high.y) - corner(low.x, high.y) - corner(high.x, low.y) +
           corner(low.x, low.y);
}

struct GapCase {
    const char* name;
    glm::dvec3 from; ///< before scaling; below the emitter: y < 0
    float scale;
    bool turned;
};

class GapShader : public DeviceTest, public ::testing::WithParamInterface<GapCase> {
  protected:
    GapShader()
        : shader_(gap_proposal_texel, ShaderOptions::texel()
                                          .set(SPEC_LIGHT_CHOICE, gpu::LIGHT_CHOICE_ONE)
                                          .set(SPEC_GAP_PROPOSAL, 1)) {
        const Scene scene = emitterUnderCeiling(GetParam().scale, GetParam().turned);
        const GpuScene packed = packScene(scene, buildWideBvh(scene));
        EXPECT_NEAR(std::abs(packed.gapWidth), kGap * GetParam().scale, 1e-5 * GetParam().scale);
        shader_.setScene(packed);
    }

    std::vector<GapAnswer> answers(const std::vector<glm::vec2>& numbers) {
        const glm::dvec3 f = GetParam().from;
        const glm::vec3 from = glm::vec3(GetParam().turned ? glm::dvec3(f.x, -f.y, -f.z) : f);
        std::vector<GapQuery> queries;
        for (const glm::vec2& u : numbers)
            queries.push_back({GetParam().scale * from, u.x, u.y, {}});
        return ask<GapAnswer>(shader_, queries);
    }

    TestShader shader_;
};

TEST_P(GapShader, DensityIsThatOfTheSamples) {
    // The smallest share of a rim is 0.03: 3e4 samples there. One in each cell of a grid, so that
    // only the few hundred cells at the ends of a region are a matter of chance.
    constexpr int kGrid = 1024;
    Random random(7);
    std::vector<glm::vec2> numbers;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; j < kGrid; ++j)
            numbers.push_back(glm::vec2(float(i) + random.uniform(), float(j) + random.uniform()) /
                              float(kGrid));
    const std::vector<GapAnswer> found = answers(numbers);
    // At a rim itself rounding may take a point for one of the emitter's.
    EXPECT_LT(std::ranges::count_if(found, [](const GapAnswer& a) { return a.pdf == 0; }), 20);

    // Beside each rim, up to `depth` from it. Axes as of an emitter that is not turned: the rims of
    // one axis are alike when it is.
    const double depth = 3 * kGap;
    const glm::dvec2 lows[] = {{-depth, 0}, {kSize.x, 0}, {0, -depth}, {0, kSize.y}};
    const glm::dvec2 highs[] = {
        {0, kSize.y}, {kSize.x + depth, kSize.y}, {kSize.x, 0}, {kSize.x, kSize.y + depth}};
    const glm::dvec2 foot(GetParam().from.x, GetParam().from.z);
    for (int rim = 0; rim < 4; ++rim) {
        double sum = 0;
        for (const GapAnswer& a : found) {
            const glm::dvec3 w(a.direction);
            // The plane's point by the direction alone: on the scene's axes, whatever the kernel's
            // are.
            const double t = -GetParam().from.y / std::abs(w.y);
            const glm::dvec2 at = foot + t * glm::dvec2(w.x, GetParam().turned ? -w.z : w.z);
            if (at.x >= lows[rim].x && at.y >= lows[rim].y && at.x < highs[rim].x &&
                at.y < highs[rim].y)
                sum += a.pdf > 0 ? 1 / double(a.pdf) : 0;
        }
        const double expected = solidAngle(lows[rim] - foot, highs[rim] - foot, -GetParam().from.y);
        EXPECT_NEAR(sum / double(found.size()) / expected, 1, 0.01) << "rim " << rim;
    }
}

TEST_P(GapShader, NothingElsewhere) {
    for (const GapAnswer& a : answers({{0.1f, 0.2f}, {0.9f, 0.7f}})) {
        EXPECT_EQ(a.pdfAtLight, 0);
        EXPECT_EQ(a.pdfBehind, 0);
    }
}

TEST_P(GapShader, EndsOfTheSquare) {
    std::vector<glm::vec2> numbers;
    const float ends[] = {0, 0x1p-24f, 0.25f, 0.5f, 1 - 0x1p-23f, 1 - 0x1p-24f};
    for (const float u : ends)
        for (const float v : ends)
            numbers.push_back({u, v});
    for (const GapAnswer& a : answers(numbers)) {
        EXPECT_NEAR(glm::length(glm::dvec3(a.direction)), 1, 1e-6); // fails for NaN
        EXPECT_GE(a.pdf, 0);
        EXPECT_TRUE(std::isfinite(a.pdf));
    }
}

INSTANTIATE_TEST_SUITE_P(Places, GapShader,
                         ::testing::Values(GapCase{"below", {0.3, -1, 0.2}, 1, false},
                                           GapCase{"beside", {1.5, -0.5, 0.3}, 1, false},
                                           GapCase{"beyondACorner", {-1, -0.7, -1.2}, 1, false},
                                           GapCase{"grazing", {-1, -0.01, 0.3}, 1, false},
                                           GapCase{"tiny", {0.9, -1, 0.9}, 1e-9f, false},
                                           GapCase{"huge", {0.9, -1, 0.9}, 1e9f, false},
                                           GapCase{"turned", {-0.4, -0.8, 0.9}, 1, true}),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace stromboli::test
