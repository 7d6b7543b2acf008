// Mixtures of materials, surfaces that are black behind, and lights that throw a picture: radiances
// that are known.
#include "tests/analytic/scenes.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stromboli {
namespace {

using namespace test;
using std::numbers::pi;

// --- Mixtures ------------------------------------------------------------------------------------

/// A sheet of the first material in light from everywhere.
Estimate seenInAmbientLight(SceneMaker& b, uint32_t material, uint32_t samples = 4096) {
    addTexturedSquare(b, material);
    b.add(ambient(1));
    RenderSettings settings = smallPicture(samples / 256, 1);
    return estimate(b.scene, pointCamera({0.4, 0.3, 2}, {0.4, 0.3, 0}), settings);
}

uint32_t mixture(SceneMaker& b, const Material& first, uint32_t other, float share) {
    Material m = first;
    m.other = other;
    m.otherShare = share;
    return b.add(m);
}

TEST(Mixtures, AreMetInTheirShares) {
    SceneMaker b;
    const uint32_t dark = b.add(diffuse(0.2f));
    const uint32_t material = mixture(b, diffuse(0.8f), dark, 0.25f);
    expectMean(seenInAmbientLight(b, material), glm::dvec3(0.75 * 0.8 + 0.25 * 0.2));
}

/// Another material on one side: the front is where the normals point.
TEST(Mixtures, MayBeOfTwoSides) {
    for (const OtherPlace place : {OtherPlace::Behind, OtherPlace::InFront})
        for (const double z : {2.0, -2.0}) {
            SceneMaker b;
            Material m = diffuse(0.8f);
            m.other = b.add(diffuse(0.2f));
            m.otherShare = 1;
            m.otherPlace = place;
            addTexturedSquare(b, b.add(m));
            b.add(ambient(1));
            RenderSettings settings = smallPicture(4, 1);
            const Camera camera = pointCamera({0.4, 0.3, z}, {0.4, 0.3, 0});
            const bool isOther = (z < 0) == (place == OtherPlace::Behind);
            expectMean(estimate(b.scene, camera, settings), isOther ? 0.2 : 0.8);
            const std::vector<uint32_t> samples(settings.area.pixelCount(), 1);
            for (const SeenPixel& p : seenBy(b.scene, camera, settings, samples, Seeing::Surfaces))
                EXPECT_NEAR(p.albedo.x, isOther ? 0.2 : 0.8, 1e-6) << "layers show that side";
        }
}

/// The picture of a material's opacity, or its negative, beside one of its colour.
TEST(Mixtures, OpacityHasAPictureOfItsOwn) {
    for (const float scale : {1.0f, -1.0f}) {
        SceneMaker b;
        TextureMaker t(b.scene);
        Material m = diffuse(0.8f);
        m.alphaMode = AlphaMode::Blend;
        m.opacity = 0.9f;
        m.textures = {
            {.slot = TextureSlot::BaseColor, .texture = t.constant(glm::vec4(0.5f, 0.5f, 0.5f, 1))},
            {.slot = TextureSlot::Opacity,
             .texture = t.constant(glm::vec4(0.25f, 1, 1, 1)),
             .scale = scale}};
        const double opacity = 0.9 * (scale < 0 ? 0.75 : 0.25);
        const uint32_t material = b.add(m);
        expectMean(seenInAmbientLight(b, material, 16384), opacity * 0.4); // behind it is nothing
    }
}

TEST(Mixtures, MayBeOfMixtures) {
    SceneMaker b;
    const uint32_t last = b.add(diffuse(0.1f));
    const uint32_t middle = mixture(b, diffuse(0.5f), last, 0.5f);
    const uint32_t material = mixture(b, diffuse(0.9f), middle, 0.5f);
    expectMean(seenInAmbientLight(b, material), glm::dvec3(0.5 * 0.9 + 0.25 * 0.5 + 0.25 * 0.1));
}

/// Mixtures of kinds with lobes of different sorts: delta ones, which light samples do not find,
/// and others.
TEST(Mixtures, MayBeOfMirrorsAndPaint) {
    SceneMaker b;
    Material mirror;
    mirror.kind = MaterialKind::Mirror;
    mirror.reflectance = glm::vec3(0.9f);
    const uint32_t other = b.add(mirror);
    const uint32_t material = mixture(b, diffuse(0.3f), other, 0.4f);
    expectMean(seenInAmbientLight(b, material), glm::dvec3(0.6 * 0.3 + 0.4 * 0.9));
}

/// A sheet of two materials under a lamp, the second one in 0.4 of cases. drawn: a rule of relief
/// of one that has no relief keeps the two from being evaluated together.
Estimate underALamp(Material first, const Material& second, bool drawn) {
    SceneMaker b;
    if (drawn) first.reliefRule = ReliefRule::Blacken;
    b.quad({-1, -1, 3}, {0, 2, 0}, {2, 0, 0}, b.add(emissive(5)));
    addTexturedSquare(b,
                      mixture(b, first, b.add(second), 0.4f)); // last: it says who has attributes
    b.add(ambient(0.2f));
    return estimate(b.scene, pointCamera({0.8, 0.3, 2}, {0.4, 0.3, 0}), smallPicture(64, 2));
}

/// One mean, with less noise where they differ.
TEST(Mixtures, EvaluatedTogetherAreAsDrawnButForNoise) {
    const Material pairs[][2] = {{diffuse(0.9f), diffuse(0.1f)},
                                 {diffuse(0.6f), metal(0.3f)},
                                 {metal(0.6f), metal(0.2f)},
                                 {diffuse(0.2f), glass(1.5f)}};
    for (const auto& [first, second] : pairs) {
        const Estimate together = underALamp(first, second, false),
                       drawn = underALamp(first, second, true);
        expectSameMean(together, drawn);
        // Where most of the noise is of bounces, it stays; errors are known to some per cent.
        EXPECT_LT(together.error.x, 1.1 * drawn.error.x);
        if (second.kind == MaterialKind::Diffuse) {
            EXPECT_LT(together.error.x, 0.5 * drawn.error.x) << "two paints";
        }
    }
}

TEST(Mixtures, FollowAPicture) {
    SceneMaker b;
    TextureMaker t(b.scene);
    const uint32_t other = b.add(diffuse(0.2f));
    Material m = diffuse(0.8f);
    m.other = other;
    m.otherShare = 0.5f;
    m.textures.push_back(
        {.slot = TextureSlot::BlendShare, .texture = t.constant(glm::vec4(0.5f, 1, 1, 1))});
    const uint32_t material = b.add(m);
    expectMean(seenInAmbientLight(b, material), glm::dvec3(0.75 * 0.8 + 0.25 * 0.2));
}

/// A mixture emits what it emits, whichever material is met.
TEST(Mixtures, KeepTheirEmission) {
    SceneMaker b;
    Material shining = emissive(2);
    const uint32_t other = b.add(shining);
    const uint32_t material = mixture(b, shining, other, 0.5f);
    addTexturedSquare(b, material);
    const Estimate found =
        estimate(b.scene, pointCamera({0.4, 0.3, 2}, {0.4, 0.3, 0}), smallPicture(16, 0));
    expectMean(found, glm::dvec3(2));
}

// --- Black behind
// ----------------------------------------------------------------------------------

double brightness(const Material& m, double cameraHeight, float normal = 0) {
    SceneMaker b;
    b.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.add(m));
    if (normal != 0) {
        b.scene.normals = {glm::vec3(0, 0, normal)};
        for (Triangle& triangle : b.scene.triangles)
            for (uint32_t& n : triangle.normals)
                n = 0;
    }
    b.add(ambient(1));
    return estimate(b.scene, pointCamera({0.5, 0.5, cameraHeight}, {0.5, 0.5, 0}),
                    smallPicture(4, 1))
        .mean.x;
}

double brightness(bool isBlackBehind, double cameraHeight, float normal = 0) {
    Material m = diffuse(0.5f);
    m.isBlackBehind = isBlackBehind;
    return brightness(m, cameraHeight, normal);
}

/// Mitsuba's principled material that is twosided: nothing enters it, so it has no inside.
TEST(BlackBacks, OpaquePrincipledSurfacesAreAlikeFromBothSides) {
    Material m;
    m.kind = MaterialKind::Burley;
    m.burley.baseColor = glm::vec3(0.5f);
    m.burley.clearcoat = 0.5f;
    const double front = brightness(m, 2);
    EXPECT_GT(front, 0.4);
    EXPECT_NEAR(brightness(m, -2), front, 0.02);
    m.isBlackBehind = true;
    EXPECT_EQ(brightness(m, -2), 0);
}

TEST(BlackBacks, AreBlackOnlyFromBehind) {
    EXPECT_NEAR(brightness(true, 2), 0.5, 0.02);
    EXPECT_EQ(brightness(true, -2), 0);
    EXPECT_NEAR(brightness(false, -2), 0.5, 0.02);
}

/// Where corners have normals, they say which side is the front.
TEST(BlackBacks, AreBehindTheShadingNormals) {
    EXPECT_NEAR(brightness(true, 2, 1), 0.5, 0.02);
    EXPECT_EQ(brightness(true, -2, 1), 0);
    EXPECT_EQ(brightness(true, 2, -1), 0);
    EXPECT_NEAR(brightness(true, -2, -1), 0.5, 0.02);
}

// --- Projectors
// ------------------------------------------------------------------------------------

/// Two metres above a white plane, looking down; u grows along x, v along y.
struct Lamp {
    Light light;
    SceneMaker b;
    TextureMaker t{b.scene};

    Lamp() {
        light.kind = LightKind::Projector;
        light.position = {0, 0, 2};
        light.direction = {0, 0, -1};
        light.color = glm::vec3(3);
        light.constantAttenuation = 0;
        light.quadraticAttenuation = 1;
        light.edgeX = {0.5f, 0, 0};
        light.edgeY = {0, 0.5f, 0};
    }
    /// Irradiance at a point of the plane.
    glm::dvec3 at(double x, double y) {
        SceneMaker scene = b;
        scene.quad({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, scene.add(diffuse(1)));
        scene.add(light);
        return estimate(scene.scene, pointCamera({x, y + 0.1, 1}, {x, y, 0}), smallPicture(1, 1))
                   .mean *
               pi;
    }
};

void expectMixed(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 2e-5 * (1 + expected[c])) << "channel " << c;
}

/// Intensity times the cube of the cosine over the squared height.
double fromSpot(double x) {
    const double cosine = 2 / std::hypot(2, x);
    return 3 * cosine * cosine * cosine / 4;
}

TEST(Projectors, EndLinearlyInTheAngle) {
    Lamp lamp;
    const auto radians = [](double degrees) { return degrees * pi / 180; };
    lamp.light.falloffAngle = float(2 * radians(40));
    lamp.light.innerAngle = float(2 * radians(20));
    for (const auto& [degrees, share] :
         {std::pair(0.0, 1.0), std::pair(19.0, 1.0), std::pair(25.0, 0.75), std::pair(35.0, 0.25),
          std::pair(41.0, 0.0)}) {
        const double x = 2 * std::tan(radians(degrees));
        expectMixed(lamp.at(x, 0), glm::dvec3(fromSpot(x) * share));
    }
}

/// A plane across is lit evenly, and nothing beyond the frame.
TEST(Projectors, LightPlanesEvenlyWithinTheirFrame) {
    Lamp lamp;
    lamp.light.isFramed = true;
    for (const double x : {0.0, 1.0, -1.9})
        expectMixed(lamp.at(x, 0.5 * x), glm::dvec3(3.0 / 4));
    expectMixed(lamp.at(2.1, 0), glm::dvec3(0));
    expectMixed(lamp.at(0, -2.1), glm::dvec3(0));
}

/// The picture's first texel is where u and v are least, also of lamps that are mirror images.
TEST(Projectors, ThrowTheirPicture) {
    for (const bool isMirrored : {false, true}) {
        Lamp lamp;
        lamp.light.isFramed = true;
        if (isMirrored) lamp.light.edgeX = -lamp.light.edgeX;
        const uint32_t image = lamp.t.bytes(
            2, 2,
            {glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1), glm::vec4(0, 0, 1, 1), glm::vec4(1)});
        lamp.light.picture =
            TextureUse{.slot = TextureSlot::Projection,
                       .texture = lamp.t.texture({.image = image, .nearest = true})};
        const double side = isMirrored ? -1 : 1;
        expectMixed(lamp.at(-side, -1), glm::dvec3(0.75, 0, 0));
        expectMixed(lamp.at(side, -1), glm::dvec3(0, 0.75, 0));
        expectMixed(lamp.at(-side, 1), glm::dvec3(0, 0, 0.75));
        expectMixed(lamp.at(side, 1), glm::dvec3(0.75));
    }
}

/// Behind a lamp there is no light.
TEST(Projectors, ShineAhead) {
    Lamp lamp;
    lamp.light.direction = {0, 0, 1};
    expectMixed(lamp.at(0, 0), glm::dvec3(0));
}

} // namespace
} // namespace stromboli
