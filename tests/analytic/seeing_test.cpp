// Layers of pictures with known answers.
#include "host/render/layers.hpp"
#include "tests/analytic/seeing.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace stromboli {
namespace {

using namespace test;

/// A floor of the albedo 0.5, above it a metre of fog, whose lower half may be of a grid; and a
/// camera above, which the fog may be around.
Scene floorInFog(const Medium& fog) {
    SceneMaker b;
    b.quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, b.add(diffuse(0.5f)));
    b.scene.media.push_back(fog);
    Material border = diffuse(0);
    border.alphaMode = AlphaMode::Blend;
    border.opacity = 0;
    border.boundsMedia = true;
    border.inside = 0;
    b.box({-8, -8, 0.5f}, {8, 8, 1.5f}, b.add(border));
    return b.scene;
}

glm::dvec3 meanOf(const std::vector<SeenPixel>& seen, glm::dvec3 SeenPixel::*sum) {
    glm::dvec3 mean(0.0);
    for (const SeenPixel& p : seen)
        mean += p.*sum / double(p.samples) / double(seen.size());
    return mean;
}

/// What media leave is seen of what is behind them, and the rest is of their own colour. Depth is
/// the surface's. 6144 tracked rays have a standard error of at most 0.008.
TEST(Layers, AreSeenThroughMedia) {
    Medium fog;
    fog.absorption = {0.25f, 0, 1};
    fog.scattering = {0.25f, 1, 0};
    for (const bool varies : {false, true}) {
        if (varies) {
            fog.density.emplace();
            fog.density->size = {1, 1, 2};
            fog.density->values = {0.5f, 1.5f}; // 1 on the mean
            fog.density->setWorld(
                glm::dmat4({16, 0, 0, 0}, {0, 16, 0, 0}, {0, 0, 1, 0}, {-8, -8, 0.5, 1}));
        }
        const Scene scene = floorInFog(fog);
        const auto seen = lookAt(scene, straightDown(), Seeing::Surfaces, 32);
        const glm::dvec3 left = glm::exp(-glm::dvec3(fog.extinction()));
        const glm::dvec3 own(0.5, 1, 0), albedo = 0.5 * left + (1.0 - left) * own;
        const glm::dvec3 t = meanOf(seen, &SeenPixel::transmittance);
        const glm::dvec3 a = meanOf(seen, &SeenPixel::albedo);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(t[c], left[c], varies ? 0.03 : 1e-5) << c;
            EXPECT_NEAR(a[c], albedo[c], varies ? 0.03 : 1e-5) << c;
        }
        for (const SeenPixel& p : seen) {
            EXPECT_EQ(p.hits, 32u);
            EXPECT_NEAR(p.position.z, 0, 32 * kNear);
            EXPECT_NEAR(p.normal.z, 32, 32 * kNear);
        }
    }
    // Around the camera, without an end, and nothing in it: its own colour.
    fog.density.reset();
    SceneMaker sky;
    sky.quad({-9, -9, 9}, {18, 0, 0}, {0, 18, 0}, sky.add(diffuse(0.5f))); // behind the camera
    sky.scene.media.push_back(fog);
    Camera inside = straightDown();
    inside.medium = 0;
    const auto seen = lookAt(sky.scene, inside, Seeing::Surfaces, 4);
    EXPECT_EQ(meanOf(seen, &SeenPixel::transmittance), glm::dvec3(0));
    EXPECT_NEAR(glm::length(meanOf(seen, &SeenPixel::albedo) - glm::dvec3(0.5, 1, 0)), 0, 1e-5);
}

FloatImage layersOf(const Scene& scene, const Camera& camera, const std::vector<Layer>& layers,
                    uint32_t samples = 16) {
    FloatImage image(kSeenArea);
    addLayers(image, layers, 0, lookAt(scene, camera, Seeing::Surfaces, samples), scene, camera);
    return image;
}

glm::dvec3 seenColor(const Scene& scene, const Camera& camera) {
    const FloatImage image = layersOf(scene, camera, {Layer::Albedo});
    const auto channel = [&](const char* name) { return double(image.channels.at(name)[0]); };
    return {channel("albedo.R"), channel("albedo.G"), channel("albedo.B")};
}

void expectNear(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], kNear) << "component " << c;
}

TEST(Layers, DepthOfAPlaneIsItsDistanceAlongTheAxis) {
    SceneMaker b;
    b.quad({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}, b.add(diffuse(0.5f)));
    Material hole = diffuse(0.5f);
    hole.alphaMode = AlphaMode::Mask;
    hole.opacity = 0;
    b.quad({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}, b.add(hole));
    for (const bool orthographic : {true, false}) {
        const FloatImage image =
            layersOf(b.scene, straightDown(orthographic), {Layer::Depth, Layer::Position});
        for (size_t i = 0; i < kSeenArea.pixelCount(); ++i) {
            EXPECT_NEAR(image.channels.at("depth.Z")[i], 5, kNear);
            EXPECT_NEAR(image.channels.at("position.Z")[i], -1, kNear);
        }
        // The mean of 16 places in a pixel of a sequence that is even in both dimensions.
        const double side = orthographic ? 0.25 : 0.25 * 5 / 4;
        EXPECT_NEAR(image.channels.at("position.X")[0], -7.5 * side, side / 8);
        EXPECT_NEAR(image.channels.at("position.Y")[0], 5.5 * side, side / 8);
    }
}

TEST(Layers, WhereNothingIsSeenDepthIsInfiniteAndTheRestIsZero) {
    SceneMaker b;
    b.quad({0, -9, 0}, {9, 0, 0}, {0, 18, 0}, b.add(diffuse(0.5f)));
    const FloatImage image = layersOf(b.scene, straightDown(),
                                      {Layer::Albedo, Layer::Normal, Layer::Depth, Layer::Position,
                                       Layer::Uv, Layer::Object, Layer::Material});
    for (const auto& [name, values] : image.channels)
        EXPECT_EQ(values[0], name == "depth.Z" ? INFINITY : 0.0f) << name;
    EXPECT_EQ(image.channels.size(), 14u);
    EXPECT_EQ(image.channels.at("object.X")[15], 1);
    EXPECT_NEAR(image.channels.at("albedo.G")[15], 0.5, kNear);
}

TEST(Layers, NormalOfASphere) {
    SceneMaker b;
    b.sphere({0, 0, 0}, 1, b.add(diffuse(0.5f)));
    const glm::dvec3 n = glm::normalize(glm::dvec3(1, 2, 2));
    const FloatImage image =
        layersOf(b.scene, pointCamera(n * 3.0 + glm::dvec3(0.3, 0, 0), n), {Layer::Normal});
    expectNear({image.channels.at("normal.X")[0], image.channels.at("normal.Y")[0],
                image.channels.at("normal.Z")[0]},
               n);
}

/// Albedo of a square whose texture has four colours, seen from the front and in a mirror.
struct TexturedSquare {
    SceneMaker b;

    TexturedSquare() {
        TextureMaker t(b.scene);
        Material m = diffuse(0.5f);
        const std::vector<glm::vec4> colors = {
            {1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
        m.textures = {{.slot = TextureSlot::BaseColor,
                       .texture = t.texture({.image = t.bytes(2, 2, colors), .nearest = true})}};
        addTexturedSquare(b, b.add(m));
    }
};

TEST(Layers, UvAndAlbedoOfATexturedSquare) {
    const TexturedSquare square;
    const Camera camera = pointCamera({0.3, 0.2, 3}, {0.75, 0.125, 0});
    const FloatImage image =
        layersOf(square.b.scene, camera, {Layer::Uv, Layer::Object, Layer::Material});
    EXPECT_NEAR(image.channels.at("uv.U")[0], 0.75, kNear);
    EXPECT_NEAR(image.channels.at("uv.V")[0], 0.875, kNear);
    EXPECT_EQ(image.channels.at("object.X")[0], 1 + square.b.scene.triangles[0].instance);
    EXPECT_EQ(image.channels.at("material.X")[0], 1);
    expectNear(seenColor(square.b.scene, camera), glm::dvec3(0.5)); // the last of the colours
}

/// Albedo of both: what the mirror shows, in the mirror's colour; the place is that of the mirror.
TEST(Layers, AlbedoAndNormalAreFollowedThroughMirrors) {
    TexturedSquare square;
    square.b.quad({-4, -4, 2}, {0, 8, 0}, {8, 0, 0}, square.b.add(mirror(0.8f))); // faces down
    TextureMaker(square.b.scene).attributes(0, {}); // the mirror has none
    // Up to the mirror and down to the upper left quarter, which is red.
    const Camera camera = pointCamera({0.25, 0.25, 1}, {0.25, 0.375, 2});
    expectNear(seenColor(square.b.scene, camera), {0.4, 0, 0});
    const FloatImage image =
        layersOf(square.b.scene, camera, {Layer::Normal, Layer::Position, Layer::Material});
    EXPECT_NEAR(image.channels.at("normal.Z")[0], 1, kNear);
    EXPECT_NEAR(image.channels.at("position.Z")[0], 2, kNear);
    EXPECT_EQ(image.channels.at("material.X")[0], 2);
}

/// A mirror that shows nothing is a surface of its own colour.
TEST(Layers, AMirrorOfTheSkyHasItsOwnAlbedo) {
    SceneMaker b;
    addFloor(b, b.add(mirror(0.7f)));
    const Camera camera = pointCamera({0, 3, 1}, {0, 0, 0});
    expectNear(seenColor(b.scene, camera), glm::dvec3(0.7));
    EXPECT_NEAR(layersOf(b.scene, camera, {Layer::Normal}).channels.at("normal.Y")[0], 1, kNear);
}

/// Two mirrors that show each other for ever.
TEST(Layers, EndlessMirrorsEnd) {
    SceneMaker b;
    const uint32_t m = b.add(mirror(0.5f));
    b.quad({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, m);
    b.quad({-50, -50, 1}, {0, 100, 0}, {100, 0, 0}, m);
    expectNear(seenColor(b.scene, pointCamera({0, 0, 0.5}, {0.01, 0, 1})),
               glm::dvec3(std::pow(0.5, 8)));
}

/// A glass pane at normal incidence shows, by 4 %, the white sky, and the rest the floor, which is
/// a third: the mean of 16 x 192 choices has a standard error of 0.003.
TEST(Layers, GlassShowsBothSides) {
    SceneMaker b;
    b.quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, b.add(diffuse(1 / 3.0f)));
    Material pane = glass(1.5f);
    b.quad({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}, b.add(pane));
    const auto seen = lookAt(b.scene, pointCamera({0, 0, 3}, {0, 0, 0}), Seeing::Surfaces);
    double sum = 0;
    for (const SeenPixel& p : seen)
        sum += p.albedo.g / p.samples;
    EXPECT_NEAR(sum / double(seen.size()), 0.04 + 0.96 / 3, 0.015);
}

TEST(Layers, AlbedoOfMetalsAndPrincipledMaterials) {
    const auto colorOf = [](const Material& m) {
        SceneMaker b;
        addFloor(b, b.add(m));
        return seenColor(b.scene, pointCamera({0, 3, 1}, {0, 0, 0}));
    };
    Material gold;
    gold.kind = MaterialKind::Conductor;
    gold.facets = {FacetDistribution::Beckmann, glm::vec2(0.1f)};
    gold.eta = {0.2f, 0.5f, 1.5f};
    gold.k = {3, 2, 0};
    const auto reflectance = [](double n, double k) {
        return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    };
    expectNear(colorOf(gold), {reflectance(0.2, 3), reflectance(0.5, 2), reflectance(1.5, 0)});
    // What is true of all interfaces of a scene is not true of walls that have none.
    SceneMaker both;
    addFloor(both, both.add(diffuse(0.3f)));
    both.sphere({0, 50, 0}, 0.1f, both.add(gold));
    expectNear(seenColor(both.scene, pointCamera({0, 3, 1}, {0, 0, 0})), glm::dvec3(0.3));
    Material paint;
    paint.kind = MaterialKind::Principled;
    paint.principled.baseColor = {0.2f, 0.4f, 0.6f};
    paint.principled.metallic = 0;
    for (const float roughness : {0.0f, 0.5f}) {
        paint.principled.roughness = roughness;
        expectNear(colorOf(paint), {0.2, 0.4, 0.6});
    }
}

/// A pixel of a part of a picture is the one of the whole, however many are looked at together.
TEST(Layers, OfAPartAreThoseOfTheWhole) {
    const Scene scene = cornellBox();
    const Camera camera = pointCamera({0.5, 0.5, 2}, {0.5, 0.5, 0}, 0.5);
    RenderSettings s = seenPicture();
    const auto whole = lookAt(scene, camera, Seeing::Surfaces, 16, s);
    s.area.crop = {5, 3, 4, 2};
    const auto part = lookAt(scene, camera, Seeing::Surfaces, 16, s);
    for (uint32_t i = 0; i < part.size(); ++i) {
        const SeenPixel& same = whole[(3 + i / 4) * 16 + 5 + i % 4];
        EXPECT_EQ(part[i].albedo, same.albedo);
        EXPECT_EQ(part[i].normal, same.normal);
        EXPECT_EQ(part[i].position, same.position);
        EXPECT_EQ(part[i].primitive, same.primitive);
    }
}

/// Glass before a floor, in every way to find light: what is seen is the same to the last bit.
TEST(Layers, DoNotDependOnHowLightIsFound) {
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.4f)));
    b.sphere({0, 1, 0}, 1, b.add(glass(1.5f)));
    b.sphere({2, 1, 0}, 1, b.add(emissive(1)));
    b.scene.environment = constantSky(1);
    const Camera camera = pointCamera({0, 2, 5}, {0, 1, 0}, 0.5);
    const auto usual = lookAt(b.scene, camera, Seeing::Surfaces);
    const std::function<void(Estimator&)> changes[] = {
        [](Estimator& e) { e.maxBounces = 0; },
        [](Estimator& e) { e.lightSamples = 5; },
        [](Estimator& e) { e.directLight = DirectLight::Hemisphere; },
        [](Estimator& e) { e.directLight = DirectLight::Bsdf; },
        [](Estimator& e) { e.branches = 3; },
        [](Estimator& e) { e.roulette.mode = Roulette::Mode::Fixed; },
        [](Estimator& e) { e.integrator = Integrator::Depth; },
    };
    for (size_t c = 0; c < std::size(changes); ++c) {
        RenderSettings s = seenPicture();
        changes[c](s.estimator);
        const auto seen = lookAt(b.scene, camera, Seeing::Surfaces, 16, s);
        for (size_t i = 0; i < seen.size(); ++i) {
            ASSERT_EQ(seen[i].albedo, usual[i].albedo) << "change " << c;
            ASSERT_EQ(seen[i].normal, usual[i].normal) << "change " << c;
            ASSERT_EQ(seen[i].primitive, usual[i].primitive) << "change " << c;
        }
    }
}

} // namespace
} // namespace stromboli
