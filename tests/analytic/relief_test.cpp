// Normal maps and heights: the light of surfaces whose normals are known.
#include "tests/analytic/scenes.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

/// A square whose normals all lean by a map. (0.6, 0, 0.8) in the frame of tangent and bitangent.
struct Mapped {
    glm::vec4 tangent{1, 0, 0, 1};
    glm::vec3 mapped{0.6f, 0, 0.8f};
    float scale = 1;
    bool smooth = false;
    ReliefRule rule = ReliefRule::Bend;
    bool shadows = false, mirrorsBehind = false;

    SceneMaker square() const {
        SceneMaker b;
        TextureMaker t(b.scene);
        Material m = diffuse(0.5f);
        m.reliefRule = rule, m.reliefShadows = shadows, m.mirrorsReliefBehind = mirrorsBehind;
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

/// Mitsuba's two-sided surfaces look behind as they do in front, in a mirror.
TEST(NormalMaps, AreSeenInAMirrorBehindWhereTheMaterialSaysSo) {
    const glm::vec3 below(kLeaning.x, kLeaning.y, -kLeaning.z);
    for (const bool smooth : {false, true})
        for (const float side : {1.0f, -1.0f}) {
            const glm::vec3 mapped = glm::normalize(glm::vec3(0.3f, 0.4f, 0.8f));
            const Mapped square{.tangent = {1, 0, 0, side},
                                .mapped = mapped,
                                .smooth = smooth,
                                .rule = ReliefRule::Flip,
                                .mirrorsBehind = true};
            const float front = glm::dot(kLeaning, glm::vec3(mapped.x, side * mapped.y, mapped.z));
            EXPECT_NEAR(square.cosine(kLeaning), front, kMapError);
            EXPECT_NEAR(square.cosine(below, -2), front, kMapError);
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

/// What a map turns away from the viewer is tilted to the other side, or black. From (2.5, 0.5, 1)
/// over the middle, the normal (-0.8, 0, 0.6) faces away: -1.6 + 0.6 < 0.
TEST(ReliefRules, WhatIsTurnedAwayIsFlippedOrBlack) {
    const glm::dvec3 at(0.5, 0.5, 0), away(2.5, 0.5, 1), near(0, 0.5, 1);
    const auto radiance = [&](ReliefRule rule, const glm::dvec3& from) {
        const Mapped square{.mapped = {-0.8f, 0, 0.6f}, .rule = rule};
        SceneMaker b = square.square();
        Light l;
        l.kind = LightKind::Directional;
        l.direction = -kLeaning;
        b.add(l);
        return estimate(b.scene, pointCamera(from, at), smallPicture(1, 1)).mean.x * kPi / 0.5;
    };
    const double facing = glm::dot(kLeaning, glm::vec3(-0.8f, 0, 0.6f)),
                 flipped = glm::dot(kLeaning, glm::vec3(0.8f, 0, 0.6f));
    for (const ReliefRule rule : {ReliefRule::Flip, ReliefRule::Blacken})
        EXPECT_NEAR(radiance(rule, near), facing, kMapError);
    EXPECT_NEAR(radiance(ReliefRule::Flip, away), flipped, kMapError);
    EXPECT_EQ(radiance(ReliefRule::Blacken, away), 0);
}

/// Conty Estevez, Lecocq and Stein 2019: a tilt of tangent 3/4 is a roughness alpha^2 of 9/128; of
/// a tangent beyond sqrt(8), 1.
TEST(ReliefRules, BumpsDimLightThatGrazes) {
    for (const glm::vec3 mapped : {glm::vec3(0.6f, 0, 0.8f), glm::vec3(0.96f, 0, 0.28f)}) {
        const double alpha2 = mapped.x < 0.9f ? 9.0 / 128 : 1;
        for (const float height : {0.1f, 0.5f, 3.0f}) {
            const glm::vec3 light = glm::normalize(glm::vec3(0.6f, 0.8f, height));
            const double tangent2 = 1 / (double(height) * height);
            const double expected =
                glm::dot(light, mapped) * 2 / (1 + std::sqrt(1 + alpha2 * tangent2));
            for (const bool smooth : {false, true})
                EXPECT_NEAR((Mapped{.mapped = mapped,
                                    .smooth = smooth,
                                    .rule = ReliefRule::Flip,
                                    .shadows = true}
                                 .cosine(light)),
                            expected, kMapError);
        }
    }
    EXPECT_NEAR(
        (Mapped{.mapped = {0, 0, 1}, .rule = ReliefRule::Flip, .shadows = true}.cosine(kLeaning)),
        kLeaning.z, kMapError);
}

/// Bounces are dimmed as light samples are: in light from everywhere, both find the same.
TEST(ReliefRules, BouncesAndLightSamplesAgree) {
    for (const bool shadows : {false, true}) {
        SceneMaker b = Mapped{.rule = ReliefRule::Flip, .shadows = shadows}.square();
        b.add(ambient(1));
        const Camera camera = pointCamera({0.6, 0.4, 2}, {0.5, 0.5, 0});
        RenderSettings settings = smallPicture(4096, 1);
        Estimate found[2];
        for (const DirectLight way : {DirectLight::Mis, DirectLight::Bsdf}) {
            settings.estimator.directLight = way;
            found[way == DirectLight::Bsdf] = estimate(b.scene, camera, settings);
        }
        const double sigma = std::hypot(found[0].error.x, found[1].error.x);
        EXPECT_NEAR(found[0].mean.x, found[1].mean.x, 4.5 * sigma + 1e-4);
    }
}

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
    bool mirrorsBehind = false;

    double cosine(const glm::vec3& light, double cameraHeight = 2) const {
        SceneMaker b;
        TextureMaker t(b.scene);
        Material m = diffuse(0.5f);
        m.mirrorsReliefBehind = mirrorsBehind;
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

/// The normal of a surface z = f(x, y) is (-f_x, -f_y, 1); v grows downwards.
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

TEST(Heights, StandOutBehindWhereTheMaterialSaysSo) {
    const glm::vec3 below(kLeaning.x, kLeaning.y, -kLeaning.z);
    const Raised square{.mirrorsBehind = true};
    const double front = glm::dot(glm::dvec3(kLeaning), glm::normalize(glm::dvec3(-0.8, 0.4, 1)));
    EXPECT_NEAR(square.cosine(kLeaning), front, kHeightError);
    EXPECT_NEAR(square.cosine(below, -2), front, kHeightError);
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

} // namespace
} // namespace stromboli
