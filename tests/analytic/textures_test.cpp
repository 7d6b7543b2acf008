// Textures, colours of corners and normal maps on surfaces whose radiance is known.
#include "tests/analytic/scenes.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

constexpr double kPi = 3.14159265358979323846;

/// Emission alone, of the point (x, y) of the square.
glm::dvec3 seen(const Scene& scene, double x, double y) {
    const Camera camera = pointCamera({x, y, 1}, {x, y, 0});
    return estimate(scene, camera, smallPicture(1, 0)).mean;
}

void expectNear(const glm::dvec3& found, const glm::dvec3& expected, double tolerance = 1e-5) {
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
    expectNear(seen(b.scene, 0.3, 0.8), {2, 0, 0});
    expectNear(seen(b.scene, 0.7, 0.8), {0, 2, 0});
    expectNear(seen(b.scene, 0.3, 0.2), {0, 0, 2});
    expectNear(seen(b.scene, 0.7, 0.2), {2, 2, 2});
}

TEST(Textures, AreMixedBetweenTexels) {
    SceneMaker b;
    TextureMaker t(b.scene);
    const uint32_t image = t.halves(2, 1, {glm::vec4(0, 4, 1, 1), glm::vec4(1, 0, 1, 1)});
    addTexturedSquare(b, b.add(textured(emissive(1), TextureSlot::Emission,
                                        t.texture({.image = image, .wrapU = Wrap::Clamp}))));
    expectNear(seen(b.scene, 0.5, 0.4), {0.5, 2, 1});
    expectNear(seen(b.scene, 0.3, 0.4), {0.1, 3.6, 1});
    expectNear(seen(b.scene, 0.1, 0.4), {0, 4, 1});
    expectNear(seen(b.scene, 0.9, 0.4), {1, 0, 1});
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
    expectNear(seen(b.scene, 0.5, 0.5), glm::dvec3(0.5));
    expectNear(seen(b.scene, 2.5, 0.5), glm::dvec3(0.21586050011389926), 0.2159 * 1.2e-4);
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
    expectNear(seen(b.scene, 0.3, 0.8), {0, 0, 1}); // (u, v) = (.3, .2): (u', v') = (.2, .7)
    expectNear(seen(b.scene, 0.3, 0.2), {1, 1, 1});
    expectNear(seen(b.scene, 0.7, 0.8), {1, 0, 0});
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
        expectNear(seen(b.scene, 2 * i + 0.4, 0.3), {1, 0, 0});
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
    expectNear(lit(b, {0.5f, 0.5f, 1}).mean, albedo / kPi);
}

/// A square whose normals all lean by a map. (0.6, 0, 0.8) in the frame of tangent and bitangent.
struct Mapped {
    glm::vec4 tangent{1, 0, 0, 1};
    glm::vec3 mapped{0.6f, 0, 0.8f};
    float scale = 1;
    bool smooth = false;

    SceneMaker square() const {
        SceneMaker b;
        TextureMaker t(b.scene);
        Material m = diffuse(0.5f);
        m.textures.push_back({.slot = TextureSlot::Normal,
                              .texture = t.constant(glm::vec4(0.5f * mapped + 0.5f, 1)),
                              .scale = scale});
        b.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.add(m));
        t.attributes(2, [&](const glm::vec3& p) {
            VertexAttributes a;
            a.uv[0] = {p.x, 1 - p.y};
            a.tangent = tangent;
            return a;
        });
        if (!smooth) return b;
        b.scene.normals = {glm::vec3(0, 0, 1)};
        for (Triangle& triangle : b.scene.triangles)
            for (uint32_t& n : triangle.normals)
                n = 0;
        return b;
    }
    /// Cosine of the shading normal to the light.
    double cosine(const glm::vec3& light, double cameraHeight = 2) const {
        SceneMaker b = square();
        Light l;
        l.kind = LightKind::Directional;
        l.direction = -light;
        b.add(l);
        const Camera camera = pointCamera({0.6, 0.4, cameraHeight}, {0.5, 0.5, 0});
        return estimate(b.scene, camera, smallPicture(1, 1)).mean.x * kPi / 0.5;
    }
};

const glm::vec3 kLeaning = glm::normalize(glm::vec3(0.3f, 0.5f, 0.7f));

/// Half floats of n/2 + 1/2 are good to 2^-12.
constexpr double kMapError = 1e-3;

TEST(NormalMaps, LeanAlongTheTangent) {
    for (const bool smooth : {false, true}) {
        const double expected = glm::dot(kLeaning, glm::vec3(0.6f, 0, 0.8f));
        EXPECT_NEAR((Mapped{.smooth = smooth}.cosine(kLeaning)), expected, kMapError);
        const double along = glm::dot(kLeaning, glm::vec3(0, 0.6f, 0.8f));
        EXPECT_NEAR((Mapped{.tangent = {0, 1, 0, 1}, .smooth = smooth}.cosine(kLeaning)), along,
                    kMapError);
    }
}

TEST(NormalMaps, BitangentTurnsRoundWhereTheMapIsMirrored) {
    const glm::vec3 mapped(0, 0.6f, 0.8f);
    EXPECT_NEAR((Mapped{.mapped = mapped}.cosine(kLeaning)),
                glm::dot(kLeaning, glm::vec3(0, 0.6f, 0.8f)), kMapError);
    EXPECT_NEAR((Mapped{.tangent = {1, 0, 0, -1}, .mapped = mapped}.cosine(kLeaning)),
                glm::dot(kLeaning, glm::vec3(0, -0.6f, 0.8f)), kMapError);
}

/// Without tangents of the mesh: along u, and the bitangent against v.
TEST(NormalMaps, TangentsFollowTheCoordinates) {
    const glm::vec3 mapped = glm::normalize(glm::vec3(0.3f, 0.4f, 0.8f));
    EXPECT_NEAR((Mapped{.tangent = glm::vec4(0), .mapped = mapped}.cosine(kLeaning)),
                glm::dot(kLeaning, mapped), kMapError);
}

TEST(NormalMaps, ScaleIsOfTheTangentialPart) {
    const glm::vec3 n = glm::normalize(glm::vec3(0.3f, 0, 0.8f));
    EXPECT_NEAR((Mapped{.scale = 0.5f}.cosine(kLeaning)), glm::dot(kLeaning, n), kMapError);
}

/// A tangent that leans towards the normal is made perpendicular to it.
TEST(NormalMaps, TangentIsMadePerpendicular) {
    const glm::vec3 t = glm::normalize(glm::vec3(1, 0, 0.7f));
    EXPECT_NEAR((Mapped{.tangent = glm::vec4(t, 1)}.cosine(kLeaning)),
                glm::dot(kLeaning, glm::vec3(0.6f, 0, 0.8f)), kMapError);
}

/// From behind, the normal is that of the front, turned round.
TEST(NormalMaps, TurnRoundOnTheOtherSide) {
    const glm::vec3 below(kLeaning.x, kLeaning.y, -kLeaning.z);
    for (const float side : {1.0f, -1.0f}) {
        const glm::vec3 mapped = glm::normalize(glm::vec3(0.3f, 0.4f, 0.8f));
        const glm::vec3 front(mapped.x, side * mapped.y, mapped.z);
        EXPECT_NEAR((Mapped{.tangent = {1, 0, 0, side}, .mapped = mapped}.cosine(below, -2)),
                    glm::dot(below, -front), kMapError);
    }
}

/// A normal that leans away from the camera so far that what it mirrors is below the surface is
/// bent until that is level: halfway between the camera and the horizon (Keller et al. 2017). No
/// rim is black, and the normal is never more turned away than that.
TEST(NormalMaps, AreBentWhereTheyWouldReflectFromBelow) {
    const glm::dvec3 mapped(-0.8, 0, 0.6);
    const Mapped square{.mapped = glm::vec3(mapped)};
    SceneMaker b = square.square();
    Light l;
    l.kind = LightKind::Directional;
    const glm::dvec3 light(0, 0, 1);
    l.direction = -glm::vec3(light);
    b.add(l);
    for (const double x : {4.5, 12.5}) {
        const glm::dvec3 from(x, 0.5, 2), at(0.5, 0.5, 0), wo = glm::normalize(from - at);
        const glm::dvec3 grazing = glm::normalize(mapped * wo.z - wo * mapped.z);
        ASSERT_NEAR(grazing.z, 0, 1e-12);
        const double expected = glm::dot(glm::normalize(wo + grazing), light);
        const double found = estimate(b.scene, pointCamera(from, at), smallPicture(1, 1)).mean.x;
        EXPECT_NEAR(found * kPi / 0.5, expected, kMapError);
    }
}

/// Nothing is gained: white surfaces with steep maps, in light from everywhere.
TEST(NormalMaps, GainNoEnergy) {
    Mapped square{.mapped = {-0.8f, 0, 0.6f}};
    SceneMaker b = square.square();
    b.scene.materials[0].albedo = glm::vec3(1);
    b.add(ambient(1));
    for (const double x : {0.5, 4.5, 20.5}) {
        const Camera camera = pointCamera({x, 0.6, 2}, {0.5, 0.5, 0});
        const Estimate found = estimate(b.scene, camera, smallPicture(256, 1));
        EXPECT_LT(found.mean.x, 1 + 4.5 * found.error.x);
        EXPECT_GT(found.mean.x, 0.4);
    }
}

/// A closed room in which all that could be constant is a texture.
/// A square of side `size` whose heights are 0, 0.4, 0.2 and 0.6 at the middles of four texels
/// (from the upper left), times `scale`: around its middle they grow by 0.8 along u and 0.4 along
/// v.
struct Raised {
    float size = 1, scale = 1;
    glm::vec3 uRow{1, 0, 0}, vRow{0, 1, 0};
    glm::vec2 uOfX{1, 0}, uOfY{0, -1}; ///< of texture coordinates by place over size
    Wrap wrap = Wrap::Clamp;
    bool nearest = false;
    glm::vec3 normal{0, 0, 1}; ///< of the corners

    double cosine(const glm::vec3& light, double cameraHeight = 2) const {
        SceneMaker b;
        TextureMaker t(b.scene);
        Material m = diffuse(0.5f);
        const auto grey = [](float x) { return glm::vec4(glm::vec3(x), 1); };
        const uint32_t image = t.bytes(2, 2, {grey(0), grey(0.4f), grey(0.2f), grey(0.6f)});
        m.textures.push_back(
            {.slot = TextureSlot::Height,
             .texture =
                 t.texture({.image = image, .wrapU = wrap, .wrapV = wrap, .nearest = nearest}),
             .uRow = uRow,
             .vRow = vRow,
             .scale = scale});
        b.quad({0, 0, 0}, {size, 0, 0}, {0, size, 0}, b.add(m));
        t.attributes(2, [&](const glm::vec3& p) {
            VertexAttributes a;
            const glm::vec2 fromMiddle = glm::vec2(p) / size - 0.5f;
            a.uv[0] = 0.5f + uOfX * fromMiddle.x + uOfY * fromMiddle.y;
            return a;
        });
        if (normal != glm::vec3(0, 0, 1)) {
            b.scene.normals = {glm::normalize(normal)};
            for (Triangle& triangle : b.scene.triangles)
                for (uint32_t& n : triangle.normals)
                    n = 0;
        }
        Light l;
        l.kind = LightKind::Directional;
        l.direction = -light;
        b.add(l);
        const double middle = size / 2;
        const Camera camera =
            pointCamera({middle + 0.1, middle - 0.1, cameraHeight}, {middle, middle, 0});
        return estimate(b.scene, camera, smallPicture(1, 1)).mean.x * kPi / 0.5;
    }
};

/// Of a surface z = f(x, y) the normal is (-f_x, -f_y, 1); v grows downwards.
double leaning(double x, double y) {
    return glm::dot(glm::dvec3(kLeaning), glm::normalize(glm::dvec3(-x, -y, 1)));
}

constexpr double kHeightError = 1e-5;

TEST(Heights, TurnTheNormalDownTheSlope) {
    EXPECT_NEAR((Raised{}.cosine(kLeaning)), leaning(0.8, -0.4), kHeightError);
    EXPECT_NEAR((Raised{.scale = -0.5f}.cosine(kLeaning)), leaning(-0.4, 0.2), kHeightError);
    EXPECT_NEAR((Raised{.nearest = true}.cosine(kLeaning)), leaning(0, 0), kHeightError);
}

/// Heights are lengths: the same picture on a larger square is less steep.
TEST(Heights, AreInMetres) {
    EXPECT_NEAR((Raised{.size = 4}.cosine(kLeaning)), leaning(0.2, -0.1), kHeightError);
    EXPECT_NEAR((Raised{.size = 1e-4f, .scale = 1e-4f}.cosine(kLeaning)), leaning(0.8, -0.4), 1e-3);
}

/// By the chain rule: of coordinates that are skewed, mirrored, transformed by the texture.
TEST(Heights, FollowTheCoordinates) {
    const Raised skewed{.uOfX = {1, 0.25f}, .uOfY = {0.5f, -1}};
    EXPECT_NEAR(skewed.cosine(kLeaning), leaning(0.8 + 0.25 * 0.4, 0.5 * 0.8 - 0.4), kHeightError);
    const Raised mirrored{.uOfX = {-1, 0}};
    EXPECT_NEAR(mirrored.cosine(kLeaning), leaning(-0.8, -0.4), kHeightError);
    const Raised transformed{.uRow = {0.5f, 0, 0.25f}, .vRow = {0.25f, 1, -0.125f}};
    EXPECT_NEAR(transformed.cosine(kLeaning), leaning(0.5 * 0.8 + 0.25 * 0.4, -0.4), kHeightError);
    const Raised backwards{.uRow = {1, 0, 1}, .wrap = Wrap::Mirror};
    EXPECT_NEAR(backwards.cosine(kLeaning), leaning(-0.8, -0.4), kHeightError);
    const Raised again{.vRow = {0, 1, 3}, .wrap = Wrap::Repeat};
    EXPECT_NEAR(again.cosine(kLeaning), leaning(0.8, -0.4), 1e-4);
}

/// From behind, a bump is a dent.
TEST(Heights, TurnRoundOnTheOtherSide) {
    const glm::dvec3 below(kLeaning.x, kLeaning.y, -kLeaning.z);
    EXPECT_NEAR((Raised{}.cosine(glm::vec3(below), -2)),
                glm::dot(below, -glm::normalize(glm::dvec3(-0.8, 0.4, 1))), kHeightError);
}

/// Along normals that are not the plane's: the plane's derivatives, made perpendicular to the
/// normal, are what is raised.
TEST(Heights, AreAlongTheShadingNormal) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, -0.2, 1));
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
    const glm::dvec3 alongX = x - glm::dot(x, n) * n + 0.8 * n,
                     alongY = y - glm::dot(y, n) * n - 0.4 * n;
    EXPECT_NEAR((Raised{.normal = {0.3f, -0.2f, 1}}.cosine(kLeaning)),
                glm::dot(glm::dvec3(kLeaning), glm::normalize(glm::cross(alongX, alongY))), 1e-4);
}

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
