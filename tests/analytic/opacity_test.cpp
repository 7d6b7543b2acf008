// Surfaces that are partly not there: n layers of opacity a let (1 - a)^n of the light through,
// wherever they lie and whoever asks.
#include "tests/analytic/scenes.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

Material layer(float opacity, float albedo = 0) {
    Material m = diffuse(albedo);
    m.alphaMode = AlphaMode::Blend;
    m.opacity = opacity;
    return m;
}

/// Where n layers lie above the floor z = 0.
using Heights = float (*)(int layer);
float apart(int i) {
    return 0.25f + 0.125f * float(i);
}
float together(int) {
    return 0.25f;
}
float close(int i) {
    return 0.25f + 0.001f * float(i);
}

SceneMaker layersOver(uint32_t floorKind, int n, float opacity, Heights height) {
    SceneMaker b;
    b.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, b.add(floorKind == 0 ? emissive(1) : diffuse(0.5f)));
    const uint32_t material = b.add(layer(opacity));
    for (int i = 0; i < n; ++i) // of different shapes, so that no two are one in memory
        b.quad({-1 - float(i) / float(100 + n), -1, height(i)}, {2.5f, 0, 0}, {0, 2, 0}, material);
    return b;
}

TEST(Opacity, PathsPassLayers) {
    for (const Heights height : {apart, together})
        for (const int n : {1, 2, 5}) {
            const SceneMaker b = layersOver(0, n, 0.25f, height);
            expectMean(estimate(b.scene, kAbove, smallPicture(64, 1)), std::pow(0.75, n));
        }
}

/// One number for each shadow ray: no noise at all. The camera is below the layers.
TEST(Opacity, ShadowRaysLoseTheSameShare) {
    for (const Heights height : {apart, together})
        for (const int n : {1, 2, 5, 40}) {
            SceneMaker b = layersOver(1, n, 0.25f, height);
            Light l;
            l.position = {0.1f, 0.2f, 16};
            b.add(l);
            const Camera below = pointCamera({0.2, 0.1, 0.1}, {0.1, 0.2, 0});
            const Estimate found = estimate(b.scene, below, smallPicture(1, 1));
            const double expected = 0.5 / kPi * std::pow(0.75, n);
            EXPECT_NEAR(found.mean.x / expected, 1, 1e-4) << n << " layers";
        }
}

/// More than a driver that limits loops lets a ray pass in one dispatch (docs/theory/kernel.md,
/// "The loop limit").
TEST(Opacity, ThousandsOfLayersCostNoPicture) {
    constexpr int n = 2000;
    constexpr float opacity = 0x1p-12f;
    const double left = std::pow(1 - double(opacity), n);
    RenderSettings s = smallPicture(4, 1);
    s.area.width = s.area.height = 4;
    expectMean(estimate(layersOver(0, n, opacity, close).scene, kAbove, s), left);
    SceneMaker b = layersOver(1, n, opacity, close);
    Light l;
    l.position = {0.1f, 0.2f, 16};
    b.add(l);
    const Camera below = pointCamera({0.2, 0.1, 0.1}, {0.1, 0.2, 0});
    s.budget.mostSamplesPerPixel = 1;
    const Estimate found = estimate(b.scene, below, s);
    EXPECT_NEAR(found.mean.x / (0.5 / kPi * left), 1, 5e-4); // 2000 roundings
    // Layers are means over the rays that the layers let through and those that they do not: all
    // hit.
    const std::vector<uint32_t> samples(s.area.pixelCount(), 2);
    for (const SeenPixel& p :
         seenBy(layersOver(0, n, opacity, close).scene, kAbove, s, samples, Seeing::Surfaces))
        EXPECT_EQ(p.hits, 2u);
}

/// Triangles in one place, to the last bit.
TEST(Opacity, EachOfTheSameTrianglesCounts) {
    SceneMaker b;
    b.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, b.add(emissive(1)));
    const uint32_t material = b.add(layer(0.5f));
    for (int i = 0; i < 3; ++i)
        b.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, material);
    expectMean(estimate(b.scene, kAbove, smallPicture(64, 1)), 0.125);
}

/// A sphere has two sides, and spheres in one place are each met.
TEST(Opacity, SpheresHaveTwoSides) {
    for (const int n : {1, 2}) {
        SceneMaker b;
        b.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, b.add(emissive(1)));
        const uint32_t material = b.add(layer(0.25f));
        for (int i = 0; i < n; ++i)
            b.sphere({0, 0, 2}, 1, material);
        expectMean(estimate(b.scene, kAbove, smallPicture(64, 1)), std::pow(0.75, 2 * n));
    }
}

/// Passing a layer is no bounce, and what the layer scatters is its opacity's share: a furnace.
TEST(Opacity, LayersAreNoBounces) {
    for (const DirectLight mode : kDirectLightModes) {
        SceneMaker b;
        b.box({-1, -1, -1}, {1, 1, 1}, b.add(diffuse(0.5f, 1)), true);
        Material m = layer(0.5f, 0.5f);
        m.emission = glm::vec3(1);
        const uint32_t material = b.add(m);
        for (int i = 0; i < 3; ++i)
            b.quad({-1, -1, -0.5f + 0.5f * float(i)}, {2, 0, 0}, {0, 2, 0}, material);
        RenderSettings s = smallPicture(64, 3);
        s.estimator.directLight = mode;
        const Camera inside = pointCamera({0.1, 0.2, 0.3}, {0.7, -0.4, 0.1}, 1.0);
        expectMean(estimate(b.scene, inside, s), 1 + 0.5 + 0.25 + 0.125);
    }
}

/// A mask is there where its opacity is at least the cutoff, and colours of corners count.
TEST(Opacity, MaskIsAllOrNothing) {
    const auto seen = [](float opacity, float color, float cutoff) {
        SceneMaker b;
        b.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, b.add(emissive(1)));
        Material m = layer(opacity);
        m.alphaMode = AlphaMode::Mask;
        m.alphaCutoff = cutoff;
        b.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, b.add(m));
        TextureMaker(b.scene).attributes(2, [&](const glm::vec3&) {
            VertexAttributes a;
            a.color = {1, 1, 1, color};
            return a;
        });
        return estimate(b.scene, kAbove, smallPicture(4, 1)).mean.x;
    };
    EXPECT_EQ(seen(0.5f, 1, 0.5f), 0);
    EXPECT_EQ(seen(0.5f, 0.75f, 0.5f), 1);
    EXPECT_EQ(seen(1, 1, 1.5f), 1);
    EXPECT_EQ(seen(0.25f, 1, 0), 0);
}

/// Light samples through a chequered mask: the lit share is that of the holes.
TEST(Opacity, MaskByTexture) {
    SceneMaker b;
    b.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, b.add(diffuse(0.5f)));
    TextureMaker t(b.scene);
    const glm::vec4 hole(1, 1, 1, 0), cloth(1, 1, 1, 1);
    Material m = layer(1);
    m.alphaMode = AlphaMode::Mask;
    m.textures = {{.slot = TextureSlot::BaseColor,
                   .texture = t.texture(
                       {.image = t.bytes(2, 2, {hole, cloth, cloth, hole}), .nearest = true})}};
    addTexturedSquare(b, b.add(m), 8, {-0.5f, -0.5f, 0.25f});
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = {0, 0, -1};
    b.add(sun);
    // From below the cloth, half of which is holes: a picture of whole squares of the pattern.
    RenderSettings s = smallPicture(64, 1);
    const Camera below = pointCamera({0, 0, 0.125}, {0.0001, 0, 0}, 1.0);
    expectMean(estimate(b.scene, below, s), 0.5 / kPi * 0.5);
}

// Surfaces that are hidden from the camera: it sees what is behind them, and all else meets them.

Material hiddenLamp() {
    Material m = emissive(3);
    m.isHiddenFromCamera = true;
    return m;
}

/// A lamp above the place (0.1, 0.2, 0) of a floor, a square or a ball, lit from between both.
SceneMaker hiddenAbove(Material floor, bool isBall) {
    SceneMaker b;
    b.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, b.add(std::move(floor)));
    const uint32_t lamp = b.add(hiddenLamp());
    if (isBall)
        b.sphere({0.1f, 0.2f, 1.5f}, 0.5f, lamp);
    else
        b.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, lamp);
    return b;
}

const Camera kStraightDown = pointCamera({0.1, 0.2, 8}, {0.1, 0.2, 0});

/// A ball of radius 1/2 whose middle is 1.5 away lights by pi (1/3)^2; a point by 4.
TEST(Hidden, TheCameraSeesWhatIsBehindLitByTheLamp) {
    SceneMaker b = hiddenAbove(diffuse(0.5f), true);
    expectMean(estimate(b.scene, kStraightDown, smallPicture(4000, 1)), 0.5 * 3 / 9.0);
    SceneMaker square = hiddenAbove(diffuse(0), false);
    expectMean(estimate(square.scene, kStraightDown, smallPicture(16, 1)), 0);
    expectMean(estimate(square.scene, kStraightDown, smallPicture(16, 0)), 0);
}

TEST(Hidden, MirrorsShowTheLamp) {
    for (const bool isBall : {false, true}) {
        SceneMaker b = hiddenAbove(mirror(0.5f), isBall);
        expectMean(estimate(b.scene, kStraightDown, smallPicture(16, 2)), 1.5);
    }
}

TEST(Hidden, PartlyTransparentSurfacesBeforeItChangeNothing) {
    SceneMaker b = hiddenAbove(emissive(1), false);
    b.quad({-1, -1, 4}, {2, 0, 0}, {0, 2, 0}, b.add(layer(0.25f)));
    expectMean(estimate(b.scene, kStraightDown, smallPicture(4000, 1)), 0.75);
}

TEST(Hidden, AlphaAndDepthAreThoseOfWhatIsBehind) {
    SceneMaker b;
    b.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, b.add(hiddenLamp()));
    const RenderSettings s = smallPicture(16, 0);
    const std::vector<uint32_t> samples(s.area.pixelCount(), 16);
    for (const SeenPixel& p : seenBy(b.scene, kStraightDown, s, samples, Seeing::Coverage))
        EXPECT_EQ(p.hits, 0u);
    b.quad({-2, -2, -3}, {4, 0, 0}, {0, 4, 0}, b.add(diffuse(0.5f)));
    for (const SeenPixel& p : seenBy(b.scene, kStraightDown, s, samples, Seeing::Surfaces)) {
        EXPECT_EQ(p.hits, 16u);
        EXPECT_NEAR(p.position.z / p.hits, -3, 1e-5);
    }
    RenderSettings depths = s;
    depths.estimator.integrator = Integrator::Depth;
    expectMean(estimate(b.scene, kStraightDown, depths), 11);
}

} // namespace
} // namespace stromboli
