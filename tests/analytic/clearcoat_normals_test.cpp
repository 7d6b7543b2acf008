// The normals of clear coats, which are not those of what lies under them.
#include "tests/analytic/scenes.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace stromboli {
namespace {

using namespace test;

/// A coat over black, on a square that lies flat or leans towards +x.
struct Coated {
    bool leans = false;                  ///< its normal is (0.6, 0, 0.8)
    std::optional<TextureSlot> map = {}; ///< which leans in the same way
    Light light = ambient(1);
    DirectLight mode = DirectLight::Mis;
    float roughness = 0.5f;
    float albedo = 0; ///< of what lies under it
    glm::dvec3 eye{0.5, -0.3, 2};

    Estimate seen(uint32_t samples) const {
        SceneMaker b;
        TextureMaker t(b.scene);
        Material m;
        m.kind = MaterialKind::Principled;
        m.principled = {.baseColor = glm::vec3(albedo),
                        .metallic = 0,
                        .specular = 0,
                        .clearcoat = 1,
                        .clearcoatRoughness = roughness};
        if (map)
            m.textures.push_back(
                {.slot = *map, .texture = t.constant(glm::vec4(0.8f, 0.5f, 0.9f, 1))});
        const glm::vec3 along = leans ? glm::vec3(0.8f, 0, -0.6f) : glm::vec3(1, 0, 0);
        b.quad(-0.5f * along - glm::vec3(0, 0.5f, 0), along, {0, 1, 0}, b.add(m));
        t.attributes(2, [&](const glm::vec3& p) {
            VertexAttributes a;
            a.uv[0] = {p.x, 1 - p.y};
            a.tangent = glm::vec4(along, 1);
            return a;
        });
        b.add(light);
        RenderSettings s = smallPicture(samples, 1);
        s.estimator.directLight = mode;
        return estimate(b.scene, pointCamera(eye, {0, 0, 0}), s);
    }
};

Light sunAlong(const glm::vec3& direction) {
    Light l;
    l.kind = LightKind::Directional;
    l.direction = -glm::normalize(direction);
    return l;
}

/// A coat with a map reflects as one that leans itself: base and coat are black otherwise.
TEST(ClearcoatNormals, LeanByTheirOwnMap) {
    for (const glm::vec3& to : {glm::vec3(0.9f, 0.1f, 0.8f), glm::vec3(0.3f, 0.5f, 1)}) {
        const Light sun = sunAlong(to);
        const double leaning = Coated{.leans = true, .light = sun}.seen(1).mean.x;
        const double mapped =
            Coated{.map = TextureSlot::ClearcoatNormal, .light = sun}.seen(1).mean.x;
        const double flat = Coated{.light = sun}.seen(1).mean.x;
        EXPECT_NEAR(mapped / leaning, 1, 0.01); // half floats lean by 1e-3
        EXPECT_GT(std::abs(flat / leaning - 1), 0.2) << "negative control";
    }
}

/// glTF: without a map of its own the coat is as the mesh says, whatever the base has.
TEST(ClearcoatNormals, AreNotTurnedByTheMapOfTheBase) {
    const Light sun = sunAlong({0.3f, 0.5f, 1});
    const double flat = Coated{.light = sun}.seen(1).mean.x;
    EXPECT_NEAR((Coated{.map = TextureSlot::Normal, .light = sun}.seen(1).mean.x) / flat, 1, 1e-3);
}

/// Light samples and bounces find the same light: the density is that of the samples. Nothing is
/// gained.
TEST(ClearcoatNormals, AreSampledAsTheyAreEvaluated) {
    for (const TextureSlot map : {TextureSlot::ClearcoatNormal, TextureSlot::Normal})
        for (const float roughness : {0.5f, 1.0f}) {
            const auto seen = [&](DirectLight mode) {
                return Coated{.map = map, .mode = mode, .roughness = roughness, .albedo = 1}.seen(
                    256);
            };
            const Estimate hemisphere = seen(DirectLight::Hemisphere);
            EXPECT_GT(hemisphere.mean.x, 0.3);
            EXPECT_LT(hemisphere.mean.x, 1 + 4.5 * hemisphere.error.x);
            for (const DirectLight mode : {DirectLight::Mis, DirectLight::Bsdf})
                expectSameMean(hemisphere, seen(mode));
        }
}

/// Samples of a rough coat go below its own horizon, some of them above that of what lies under it:
/// they are no samples of that, whose light would be counted twice.
TEST(ClearcoatNormals, LoseWhatGoesBelowTheirHorizon) {
    const auto seen = [](DirectLight mode) {
        return Coated{.map = TextureSlot::ClearcoatNormal,
                      .mode = mode,
                      .roughness = 1,
                      .albedo = 1,
                      .eye = {0, 2, 0.6}}
            .seen(8192);
    };
    expectSameMean(seen(DirectLight::Hemisphere), seen(DirectLight::Bsdf));
}

} // namespace
} // namespace stromboli
