// Textures, colours of corners and normal maps on surfaces whose radiance is known.
#include "tests/analytic/scenes.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

/// Emission alone, of the point (x, y) of the square.
glm::dvec3 seen(const Scene& scene, double x, double y) {
    const Camera camera = pointCamera({x, y, 1}, {x, y, 0});
    return estimate(scene, camera, smallPicture(1, 0)).mean;
}

void expectClose(const glm::dvec3& found, const glm::dvec3& expected, double tolerance = 1e-5) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << "channel " << c;
}

Material textured(const Material& material, TextureSlot slot, uint32_t texture) {
    Material m = material;
    m.textures.push_back({.slot = slot, .texture = texture});
    return m;
}

const glm::vec4 kRed(1, 0, 0, 1), kGreen(0, 1, 0, 1), kBlue(0, 0, 1, 1), kWhite(1);

TEST(Textures, FirstTexelIsUpperLeft) {
    SceneMaker b;
    TextureMaker t(b.scene);
    const uint32_t image = t.bytes(2, 2, {kRed, kGreen, kBlue, kWhite});
    const uint32_t nearest = t.texture({.image = image, .nearest = true});
    addTexturedSquare(b, b.add(textured(emissive(2), TextureSlot::Emission, nearest)));
    expectClose(seen(b.scene, 0.3, 0.8), {2, 0, 0});
    expectClose(seen(b.scene, 0.7, 0.8), {0, 2, 0});
    expectClose(seen(b.scene, 0.3, 0.2), {0, 0, 2});
    expectClose(seen(b.scene, 0.7, 0.2), {2, 2, 2});
}

TEST(Textures, AreMixedBetweenTexels) {
    SceneMaker b;
    TextureMaker t(b.scene);
    const uint32_t image = t.halves(2, 1, {glm::vec4(0, 4, 1, 1), glm::vec4(1, 0, 1, 1)});
    addTexturedSquare(b, b.add(textured(emissive(1), TextureSlot::Emission,
                                        t.texture({.image = image, .wrapU = Wrap::Clamp}))));
    expectClose(seen(b.scene, 0.5, 0.4), {0.5, 2, 1});
    expectClose(seen(b.scene, 0.3, 0.4), {0.1, 3.6, 1});
    expectClose(seen(b.scene, 0.1, 0.4), {0, 4, 1});
    expectClose(seen(b.scene, 0.9, 0.4), {1, 0, 1});
}

/// Decoded before it is mixed: half way between black and white is one half.
TEST(Textures, SrgbIsDecodedFirst) {
    SceneMaker b;
    TextureMaker t(b.scene);
    const uint32_t image = t.bytes(2, 1, {glm::vec4(0, 0, 0, 1), glm::vec4(1, 1, 1, 1)});
    const uint32_t grey = t.bytes(1, 1, {glm::vec4(128 / 255.0f)});
    Material m = textured(emissive(1), TextureSlot::Emission,
                          t.texture({.image = image, .wrapU = Wrap::Clamp, .srgb = true}));
    addTexturedSquare(b, b.add(m));
    m.textures[0].texture = t.texture({.image = grey, .srgb = true});
    addTexturedSquare(b, b.add(m), 1, {2, 0, 0});
    expectClose(seen(b.scene, 0.5, 0.5), glm::dvec3(0.5));
    expectClose(seen(b.scene, 2.5, 0.5), glm::dvec3(0.21586050011389926), 0.2159 * 1.2e-4);
}

/// The second set of coordinates, turned by a quarter: u' = v, v' = 1 - u.
TEST(Textures, HaveTheirOwnCoordinates) {
    SceneMaker b;
    TextureMaker t(b.scene);
    const uint32_t image = t.bytes(2, 2, {kRed, kGreen, kBlue, kWhite});
    Material m = emissive(1);
    m.textures.push_back({.slot = TextureSlot::Emission,
                          .texture = t.texture({.image = image, .nearest = true}),
                          .uvSet = 1,
                          .uRow = {0, 1, 0},
                          .vRow = {-1, 0, 1}});
    b.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.add(m));
    t.attributes(2, [](const glm::vec3& p) {
        VertexAttributes a;
        a.uv[1] = {p.x, 1 - p.y};
        return a;
    });
    expectClose(seen(b.scene, 0.3, 0.8), {0, 0, 1}); // (u, v) = (.3, .2): (u', v') = (.2, .7)
    expectClose(seen(b.scene, 0.3, 0.2), {1, 1, 1});
    expectClose(seen(b.scene, 0.7, 0.8), {1, 0, 0});
}

/// Coordinates that no picture has, and triangles without any: some texel, no more.
TEST(Textures, DegenerateCoordinatesAreHarmless) {
    SceneMaker b;
    TextureMaker t(b.scene);
    const Material m = textured(emissive(1), TextureSlot::Emission,
                                t.texture(t.bytes(2, 2, std::vector(4, kRed))));
    const uint32_t material = b.add(m);
    const float values[] = {NAN, INFINITY, -INFINITY, 3e38f, -1e-30f, 1e20f};
    for (int i = 0; i < 6; ++i) {
        b.quad({float(2 * i), 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
        t.attributes(2, [&](const glm::vec3&) {
            VertexAttributes a;
            a.uv[0] = glm::vec2(values[i]);
            return a;
        });
    }
    b.quad({12, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
    t.attributes(0, {});
    for (int i = 0; i < 7; ++i)
        expectClose(seen(b.scene, 2 * i + 0.4, 0.3), {1, 0, 0});
}

/// What a Lambertian square at the point (0.5, 0.5) sends to a camera over it.
Estimate lit(SceneMaker& b, const glm::vec3& light) {
    Light l;
    l.position = light;
    b.add(l);
    return estimate(b.scene, pointCamera({0.6, 0.4, 2}, {0.5, 0.5, 0}), smallPicture(1, 1));
}

/// Albedo, texture and colours of corners are factors of one product.
TEST(Textures, AlbedoIsAProduct) {
    SceneMaker b;
    TextureMaker t(b.scene);
    Material m = textured(diffuse(0.5f), TextureSlot::BaseColor, t.constant({0.5f, 0.25f, 1, 1}));
    b.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.add(m));
    t.attributes(2, [](const glm::vec3& p) {
        VertexAttributes a;
        a.color = glm::vec4(p.x, 1, p.y, 1);
        return a;
    });
    const glm::dvec3 albedo = 0.5 * glm::dvec3(0.5, 0.25, 1) * glm::dvec3(0.5, 1, 0.5);
    expectClose(lit(b, {0.5f, 0.5f, 1}).mean, albedo / kPi);
}

/// A closed room in which all that could be constant is a texture.
TEST(Textures, FurnaceOfConstantTextures) {
    SceneMaker b;
    TextureMaker t(b.scene);
    Material m = diffuse(1, 2);
    m.textures = {{.slot = TextureSlot::BaseColor, .texture = t.constant(glm::vec4(0.5f))},
                  {.slot = TextureSlot::Emission, .texture = t.constant(glm::vec4(0.5f))}};
    b.box({-1, -1, -1}, {1, 1, 1}, b.add(m), true);
    t.attributes(12, [](const glm::vec3& p) {
        VertexAttributes a;
        a.uv[0] = {p.x, p.y};
        return a;
    });
    const Camera inside = pointCamera({0.1, 0.2, 0.3}, {0.7, -0.4, 0.1}, 1.0);
    for (const DirectLight mode : kDirectLightModes)
        for (const uint32_t branches : {1u, 2u}) {
            RenderSettings s = smallPicture(16, 3);
            s.estimator.directLight = mode;
            s.estimator.branches = branches;
            expectMean(estimate(b.scene, inside, s), 1 + 0.5 + 0.25 + 0.125);
        }
}

/// A lamp of which the texture leaves one half dark is a lamp of half the size.
class TexturedLamp : public testing::Test {
  protected:
    static Estimate litBy(const std::function<void(SceneMaker&)>& addLamp, DirectLight mode,
                          const Material& floor) {
        SceneMaker b;
        b.quad({-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, b.add(floor));
        addLamp(b);
        RenderSettings s = smallPicture(256, 2);
        s.estimator.directLight = mode;
        return estimate(b.scene, pointCamera({1, 0.5, -1}, {0.2, 0.3, -2}), s);
    }
    static void half(SceneMaker& b) {
        Material m = emissive(3);
        b.quad({0.5f, 0, 0}, {0.5f, 0, 0}, {0, 1, 0}, b.add(m));
    }
    static uint32_t halfDark(SceneMaker& b, const glm::vec4& dark) {
        TextureMaker t(b.scene);
        return t.texture({.image = t.bytes(2, 1, {dark, kWhite}), .nearest = true});
    }
    static void byTexture(SceneMaker& b) {
        addTexturedSquare(
            b, b.add(textured(emissive(3), TextureSlot::Emission, halfDark(b, {0, 0, 0, 1}))));
    }
    static void byMask(SceneMaker& b) {
        Material m = textured(emissive(3), TextureSlot::BaseColor, halfDark(b, {1, 1, 1, 0}));
        m.alphaMode = AlphaMode::Mask;
        addTexturedSquare(b, b.add(m));
    }
};

TEST_F(TexturedLamp, ShinesWhereItsTextureDoes) {
    for (const DirectLight mode : kDirectLightModes)
        expectSameMean(litBy(half, mode, diffuse(0.5f)), litBy(byTexture, mode, diffuse(0.5f)));
}

TEST_F(TexturedLamp, ShinesWhereItsMaskIs) {
    for (const DirectLight mode : kDirectLightModes)
        expectSameMean(litBy(half, mode, diffuse(0.5f)), litBy(byMask, mode, diffuse(0.5f)));
}

/// Light samples and bounces share the light of a rough metal's surroundings.
TEST_F(TexturedLamp, IsSharedByLightSamplesAndBounces) {
    for (const DirectLight mode : {DirectLight::Mis, DirectLight::Bsdf}) {
        expectSameMean(litBy(half, mode, metal(0.4f)), litBy(byTexture, mode, metal(0.4f)));
        expectSameMean(litBy(half, mode, metal(0.4f)), litBy(byMask, mode, metal(0.4f)));
    }
}

} // namespace
} // namespace stromboli
