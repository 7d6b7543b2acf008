// Emitters with a shape over a diffuse floor of albedo 0.5, whose irradiance has a closed form, in
// all three direct light modes.
#include "tests/analytic/scenes.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

const Camera kSeesOrigin = pointCamera({3, 2, 3}, {0, 0, 0});

/// Lambert 1760: irradiance at the origin, normal n, from a polygon of radiance 1 above the
/// horizon.
double polygonIrradiance(const std::vector<glm::dvec3>& corners, const glm::dvec3& n) {
    double sum = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = glm::normalize(corners[i]);
        const glm::dvec3 b = glm::normalize(corners[(i + 1) % corners.size()]);
        sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), n);
    }
    return std::abs(sum) / 2;
}

class Emitters : public testing::TestWithParam<DirectLight> {
  protected:
    SceneMaker builder;
    RenderSettings settings = smallPicture(256, 1);

    void SetUp() override {
        settings.estimator.directLight = GetParam();
        addFloor(builder, builder.add(diffuse(0.5f)));
    }
    void expectIrradiance(double irradiance) {
        expectMean(estimate(builder.scene, kSeesOrigin, settings), 0.5 / kPi * irradiance);
    }
    /// 1 x 0.5 at height 1, beside the origin; the normal points down, or up.
    void addQuadEmitter(bool down, bool bothSides) {
        const glm::vec3 a(1, 0, 0), b(0, 0.25f, 0.5f);
        builder.quad({-0.25f, 1, 0.25f}, down ? a : b, down ? b : a,
                     builder.add(emissive(2, bothSides)));
    }
    double quadIrradiance() const {
        return 2 * polygonIrradiance(
                       {{-0.25, 1, 0.25}, {0.75, 1, 0.25}, {0.75, 1.25, 0.75}, {-0.25, 1.25, 0.75}},
                       {0, 1, 0});
    }
};

TEST_P(Emitters, Quad) {
    addQuadEmitter(true, true);
    expectIrradiance(quadIrradiance());
}

TEST_P(Emitters, OneSidedQuadFacingTheFloor) {
    addQuadEmitter(true, false);
    expectIrradiance(quadIrradiance());
}

TEST_P(Emitters, OneSidedQuadFacingAway) {
    addQuadEmitter(false, false);
    expectIrradiance(0);
}

TEST_P(Emitters, TwoSidedQuadFacingAway) {
    addQuadEmitter(false, true);
    expectIrradiance(quadIrradiance());
}

TEST_P(Emitters, MeshOfUnequalTriangles) {
    const uint32_t material = builder.add(emissive(2));
    const std::vector<glm::dvec3> fan = {
        {-1, 1, 0}, {0, 1, 1}, {0.25, 1, 1}, {1, 1, 0.5}, {0.5, 1, -0.5}};
    builder.startInstance();
    for (size_t i = 1; i + 1 < fan.size(); ++i)
        builder.triangle(fan[0], fan[i + 1], fan[i], material);
    expectIrradiance(2 * polygonIrradiance(fan, {0, 1, 0}));
}

TEST_P(Emitters, Sphere) {
    builder.sphere({0.75f, 1, 0}, 0.25f, builder.add(emissive(2)));
    const double distance2 = 1 + 0.75 * 0.75;
    expectIrradiance(2 * kPi * 0.25 * 0.25 / distance2 * (1 / std::sqrt(distance2)));
}

TEST_P(Emitters, InsideASphere) {
    builder.sphere({0, 0, 0}, 8, builder.add(emissive(2)));
    expectIrradiance(2 * kPi);
}

TEST_P(Emitters, InsideAOneSidedSphere) {
    builder.sphere({0, 0, 0}, 8, builder.add(emissive(2, false)));
    expectIrradiance(0);
}

TEST_P(Emitters, EmittersAddUp) {
    addQuadEmitter(true, true);
    builder.sphere({0, 1, -1}, 0.25f, builder.add(emissive(2)));
    Light ambient;
    ambient.kind = LightKind::Ambient;
    builder.add(ambient);
    const double sphere = 2 * kPi * 0.0625 / 2 / std::sqrt(2.0), quad = quadIrradiance();
    // The emitters hide as much of the ambient light as they give, for their own radiance of 2.
    expectIrradiance(kPi + (sphere + quad) / 2);
}

TEST_P(Emitters, EmitterSeenByTheCamera) {
    builder.sphere({0, 0, 0}, 0.5f, builder.add(emissive(2)));
    expectMean(estimate(builder.scene, kSeesOrigin, settings), 2);
    settings.estimator.minBounce = 1;
    expectMean(estimate(builder.scene, kSeesOrigin, settings), 0);
}

TEST_P(Emitters, MirrorShowsTheEmitter) {
    builder.scene.materials[0].kind = MaterialKind::Mirror;
    builder.scene.materials[0].reflectance = glm::vec3(0.25f);
    builder.sphere({-3, 2, -3}, 0.5f, builder.add(emissive(2)));
    expectMean(estimate(builder.scene, kSeesOrigin, settings), 0.5);
    settings.estimator.minBounce = 2;
    settings.estimator.maxBounces = 4;
    expectMean(estimate(builder.scene, kSeesOrigin, settings), 0);
}

INSTANTIATE_TEST_SUITE_P(AllModes, Emitters, testing::ValuesIn(kDirectLightModes),
                         [](const auto& one) { return test::testName(nameOf(one.param)); });

TEST(FarSphere, LightsModeFindsWhatNoOtherModeWould) {
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.5f)));
    b.sphere({0, 1e4f, 0}, 0.25f, b.add(emissive(1e9f)));
    expectMean(estimate(b.scene, kSeesOrigin, smallPicture(16, 1)), 0.5 * 1e9 * 0.0625 / 1e8);
}

/// A complete scene: all materials, an emitter, many bounces.
class Modes : public testing::Test {
  protected:
    Scene scene = cornellBox();
    Camera camera = pointCamera({0.5, 0.5, 0.95}, {0.5, 0.4, 0}, 0.8);
    Estimate render(DirectLight mode, Roulette::Mode roulette, uint32_t min, uint32_t max,
                    uint32_t seed) {
        RenderSettings s = smallPicture(400, max);
        s.estimator.minBounce = min;
        s.estimator.directLight = mode;
        s.estimator.roulette.mode = roulette;
        s.estimator.roulette.terminationProbability = 0.3;
        s.estimator.seed = seed;
        return estimate(scene, camera, s);
    }
};

TEST_F(Modes, DirectLightModesAgree) {
    const Estimate lights = render(DirectLight::Mis, Roulette::Mode::Throughput, 0, 6, 1);
    expectSameMean(render(DirectLight::Hemisphere, Roulette::Mode::Throughput, 0, 6, 2), lights);
    expectSameMean(render(DirectLight::Bsdf, Roulette::Mode::Throughput, 0, 6, 3), lights);
}

TEST_F(Modes, RouletteDoesNotChangeTheMean) {
    const Estimate none = render(DirectLight::Mis, Roulette::Mode::None, 0, 8, 4);
    expectSameMean(render(DirectLight::Mis, Roulette::Mode::Throughput, 0, 8, 5), none);
    expectSameMean(render(DirectLight::Mis, Roulette::Mode::Fixed, 0, 8, 6), none);
}

TEST_F(Modes, NumbersOfBouncesPartitionTheSum) {
    const Estimate whole = render(DirectLight::Mis, Roulette::Mode::None, 0, 4, 7);
    Estimate sum;
    for (uint32_t k = 0; k <= 4; ++k) {
        const Estimate part = render(DirectLight::Mis, Roulette::Mode::None, k, k, 10 + k);
        EXPECT_TRUE(part.mean.x > 0 || k == 0); // the emitter is behind the camera
        sum.mean += part.mean;
        sum.error = glm::sqrt(sum.error * sum.error + part.error * part.error);
    }
    expectSameMean(sum, whole);
}

} // namespace
} // namespace stromboli
