// Grids of densities and colours with known answers (docs/theory/media.md): what their means leave,
// furnaces, channels that are what they are alone, and radiance that varies.
#include "tests/analytic/media.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

// --- Grids ---------------------------------------------------------------------------------------

/// A grid of two layers of cells along z over the slab, of densities a below and b above: between
/// their middles the density rises linearly, and the mean is that of both.
SceneMaker slabOfLayers(const Medium& m, float a, float b) {
    SceneMaker scene = slab(m);
    DensityGrid grid;
    grid.size = {2, 3, 2};
    grid.values = {a, a, a, a, a, a, b, b, b, b, b, b};
    grid.toUnit = {glm::dvec4(1 / 160.0, 0, 0, 0.5), glm::dvec4(0, 1 / 160.0, 0, 0.5),
                   glm::dvec4(0, 0, 1 / double(kThickness), -0.25 / kThickness)};
    scene.scene.media[0].density = grid;
    return scene;
}

TEST(Media, GridsAbsorbByTheirMeanDensity) {
    const glm::vec3 absorption(0.3f, 1.5f, 0.125f);
    const SceneMaker b = slabOfLayers(mediumOf(absorption, glm::vec3(0)), 0.25f, 2);
    expectMean(estimate(b.scene, kAbove, smallPicture(256, 1)),
               exponential(1.125 * lengthInSlab() * glm::dvec3(absorption)));
}

TEST(Media, ShadowRaysGoThroughGrids) {
    const glm::vec3 extinction(0.3f, 1.5f, 0.125f);
    SceneMaker b = slabOfLayers(mediumOf(extinction, glm::vec3(0)), 0.25f, 2);
    b.scene.materials[0] = diffuse(0.5f);
    Light l;
    l.position = {0.1f, 0.2f, 16};
    b.add(l);
    const Camera below = pointCamera({0.2, 0.1, 0.1}, {0.1, 0.2, 0});
    expectMean(estimate(b.scene, below, smallPicture(256, 1)),
               0.5 / kPi * exponential(1.125 * double(kThickness) * glm::dvec3(extinction)));
}

/// A grid that is the same everywhere is the medium without one; a white one is a furnace whatever
/// is in it.
TEST(Media, WhiteGridsAreFurnaces) {
    DensityGrid grid;
    grid.size = {20, 18, 3};
    for (uint32_t i = 0; i < 20u * 18 * 3; ++i)
        grid.values.push_back(i % 7 == 0 ? 0.0f : float(i % 5));
    grid.toUnit = {glm::dvec4(0.5, 0, 0, 0.5), glm::dvec4(0, 0.5, 0, 0.5),
                   glm::dvec4(0, 0, 0.5, 0.5)};
    for (const float g : {0.0f, 0.8f}) {
        SceneMaker b;
        b.box({-2, -2, -2}, {2, 2, 2}, b.add(emissive(1)), true);
        Medium m = mediumOf(glm::vec3(0), glm::vec3(4, 2, 1), g);
        m.density = grid;
        Camera camera = pointCamera({-1.5, 0.1, 0.3}, {1, 0.4, 0.2});
        camera.medium = b.add(m);
        expectMean(estimate(b.scene, camera, smallPicture(64, 10'000)), 1);
    }
}

// --- Grids of colours ----------------------------------------------------------------------------

/// The slab's cube, whatever is in it.
constexpr double kPerLength = 1 / 160.0, kPerHeight = 1 / double(kThickness);
const std::array<glm::dvec4, 3> kSlabToUnit = {glm::dvec4(kPerLength, 0, 0, 0.5),
                                               glm::dvec4(0, kPerLength, 0, 0.5),
                                               glm::dvec4(0, 0, kPerHeight, -0.25 * kPerHeight)};

/// Two layers of the slab, of one cell each.
ColorGrid twoLayers(const glm::vec3& below, const glm::vec3& above) {
    ColorGrid grid;
    grid.size = {1, 1, 2};
    grid.values = {below, above};
    grid.toUnit = kSlabToUnit;
    return grid;
}

/// Each channel has the mean of its own densities, for camera rays and for rays to a light.
TEST(Media, GridsOfColoursAbsorbByChannel) {
    const glm::vec3 absorption(0.3f, 1.5f, 0.125f), below(0.25f, 0, 3), above(2, 0.5f, 0);
    Medium m = mediumOf(absorption, glm::vec3(0));
    m.colors.extinction = twoLayers(below, above);
    const glm::dvec3 depth = 0.5 * glm::dvec3(absorption) * glm::dvec3(below + above);
    const SceneMaker seen = slab(m);
    expectMean(estimate(seen.scene, kAbove, smallPicture(256, 1)),
               exponential(lengthInSlab() * depth));
    SceneMaker lit = slab(m);
    lit.scene.materials[0] = diffuse(0.5f);
    Light l;
    l.position = {0.1f, 0.2f, 16};
    lit.add(l);
    expectMean(
        estimate(lit.scene, pointCamera({0.2, 0.1, 0.1}, {0.1, 0.2, 0}), smallPicture(256, 1)),
        0.5 / kPi * exponential(double(kThickness) * depth));
}

/// Colours from 0 to 4 in a box from -1 to 1.
ColorGrid motley(const glm::uvec3& size, float scale) {
    ColorGrid grid;
    grid.size = size;
    for (uint32_t i = 0; i < size.x * size.y * size.z; ++i)
        grid.values.push_back(scale * glm::vec3(i % 5, i % 3, i % 7 == 0 ? 4 : 0));
    grid.toUnit = {glm::dvec4(0.5, 0, 0, 0.5), glm::dvec4(0, 0.5, 0, 0.5),
                   glm::dvec4(0, 0, 0.5, 0.5)};
    return grid;
}

/// What scatters all is a furnace, by shares of 1 and by factors that are those of the extinction.
TEST(Media, WhiteGridsOfColoursAreFurnaces) {
    for (const bool isFactor : {false, true}) {
        SceneMaker b;
        b.box({-1, -1, -1}, {1, 1, 1}, b.add(emissive(1)), true);
        Medium m = mediumOf(glm::vec3(0.25f), glm::vec3(1, 0.5f, 0.25f), 0.4f);
        m.colors.extinction = motley({5, 18, 3}, 1);
        m.colors.scattering = m.colors.extinction;
        m.colors.scatteringIsFactor = isFactor;
        if (!isFactor) m.colors.scattering->values.assign(5 * 18 * 3, glm::vec3(1));
        Camera camera = pointCamera({-0.5, 0.1, 0.3}, {1, 0.4, 0.2});
        camera.medium = b.add(m);
        expectMean(estimate(b.scene, camera, smallPicture(32, 10'000)), 1);
    }
}

/// Each channel is what it is alone, where extinction and albedo vary in colour, on grids of their
/// own.
TEST(Media, ChannelsOfGridsAreWhatTheyAreAlone) {
    Medium together = mediumOf(glm::vec3(0.5f, 1, 0.25f), glm::vec3(0.5f), 0.3f);
    together.colors.extinction = motley({3, 2, 5}, 0.5f);
    together.colors.scattering = motley({2, 3, 1}, 0.25f);
    const auto seen = [](const Medium& m) {
        SceneMaker b;
        b.add(ambient(1));
        b.box({-1, -1, -1}, {1, 1, 1}, b.add(border(b.add(m))));
        return estimate(b.scene, pointCamera({0.2, 0.3, 3}, {0.1, 0.2, 0}),
                        smallPicture(128, 1000));
    };
    const Estimate all = seen(together);
    for (int c = 0; c < 3; ++c) {
        Medium alone = mediumOf(glm::vec3(together.extinction()[c]), glm::vec3(0), 0.3f);
        alone.density.emplace();
        alone.density->size = together.colors.extinction->size;
        alone.density->toUnit = together.colors.extinction->toUnit;
        for (const glm::vec3& color : together.colors.extinction->values)
            alone.density->values.push_back(color[c]);
        alone.colors.scattering = together.colors.scattering;
        for (glm::vec3& color : alone.colors.scattering->values)
            color = glm::vec3(color[c]);
        const Estimate found = seen(alone);
        EXPECT_NEAR(all.mean[c], found.mean[c],
                    4.5 * std::hypot(all.error[c], found.error[c]) + kRounding)
            << c;
    }
}

/// What a slab that absorbs sends up, and the floor behind it: the integral over the way of
/// absorption times radiance times what is left.
glm::dvec3 radianceOfSlab(const Medium& m) {
    constexpr int kSteps = 4000;
    glm::dvec3 left(1.0), sum(0.0);
    const double step = lengthInSlab() / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        const glm::dvec3 unit(0.5, 0.5, 1 - (i + 0.5) / kSteps);
        const MediumPoint p = m.at({0, 0, 0.25 + double(kThickness) * unit.z}, unit);
        const glm::dvec3 half = exponential(0.5 * step * p.extinction);
        sum += left * half * p.emission * step;
        left *= half * half;
    }
    return sum + left;
}

/// Radiance of varying colours, and glow by temperatures that vary.
TEST(Media, ShineInColoursThatVary) {
    Medium m = mediumOf(glm::vec3(1.5f, 0.75f, 1), glm::vec3(0));
    m.colors.extinction = twoLayers({1, 2, 0.5f}, {2, 0.25f, 1});
    m.colors.source = twoLayers({4, 0, 1}, {0.5f, 3, 2});
    const auto expectShine = [&] {
        const SceneMaker b = slab(m);
        const Estimate found = estimate(b.scene, kAbove, smallPicture(1024, 2));
        const glm::dvec3 expected = radianceOfSlab(m);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.mean[c], expected[c], 4.5 * found.error[c] + 1e-5 * expected[c]) << c;
    };
    expectShine();
    m.density.emplace();
    m.density->size = {1, 1, 2};
    m.density->values = {0.5f, 1.5f};
    m.density->toUnit = kSlabToUnit;
    m.colors.extinction.reset();
    m.colors.source = twoLayers({1, 1200, 0}, {2, 300, 0}); // a factor, kelvins
    m.colors.glow = GlowTable{500, 1500, {{0.5f, 1, 0, -3}, {1, 0.5f, 0.25f, 1}, {1, 1, 1, 2}}};
    expectShine();
}

} // namespace
} // namespace stromboli
