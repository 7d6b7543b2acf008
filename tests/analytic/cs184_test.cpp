// The CS184 renderer's conventions of shading: each deviation from the physical rules, by its
// closed form. What the loader resolves (attenuation, spot lights) is in tests/scene.
#include "host/cs184/cs184.hpp"
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

constexpr double kF = 0.5 / kPi;
const Camera kFromAbove = pointCamera({3, 2, 3}, {0, 0, 0});
const Camera kFromBelow = pointCamera({3, -2, 3}, {0, 0, 0});

RenderSettings cs184(uint32_t samples, uint32_t maxBounces = 1) {
    RenderSettings s = smallPicture(samples, maxBounces);
    s.estimator.conventions = cs184Shading();
    return s;
}

SceneMaker floor() {
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.5f)));
    return b;
}

/// Tiny rectangle of radiance 1e6 at `position`, emitting along `normal`.
Light rectangle(const glm::vec3& position, const glm::vec3& normal) {
    Light light;
    light.kind = LightKind::Area;
    light.color = glm::vec3(1e6f);
    light.position = position;
    light.direction = normal;
    light.edgeX = {1e-3f, 0, 0};
    light.edgeY = {0, 0, 1e-3f};
    return light;
}

TEST(Cs184, AreaLightFallsOffWithDistanceNotItsSquare) {
    for (float height : {1.0f, 2.0f, 4.0f}) {
        SceneMaker b = floor();
        b.add(rectangle({0, height, 0}, {0, -1, 0}));
        // Radiance times area is 1; the emitter is small enough for a point to 1e-6.
        const Estimate found = estimate(b.scene, kFromAbove, cs184(16));
        EXPECT_NEAR(found.mean.x / (kF / height), 1, 1e-6);
    }
}

TEST(Cs184, AreaLightIsOneSidedAndHiddenFromCameras) {
    SceneMaker b = floor();
    b.add(rectangle({0, 1, 0}, {0, 1, 0}));
    expectMean(estimate(b.scene, kFromAbove, cs184(4)), 0);
    Scene alone;
    alone.lights.push_back(rectangle({0, 0, 0}, {0, 1, 0}));
    expectMean(estimate(alone, kFromAbove, cs184(4)), 0);
}

TEST(Cs184, MeshInTheLightsPlaneDoesNotShadeIt) {
    SceneMaker b = floor();
    // 1.49 and its neighbours in float: what transforms of two objects give.
    for (float y : {1.49f, std::nextafter(1.49f, 1.0f), std::nextafter(1.49f, 2.0f)}) {
        b.scene.triangles.resize(2);
        Light light = rectangle({0, 1.49f, 0}, {0, -1, 0});
        b.add(light);
        b.quad({-0.5f, y, -0.5f}, {1, 0, 0}, {0, 0, 1}, b.add(emissive(10)));
        const Estimate found = estimate(b.scene, kFromAbove, cs184(4));
        EXPECT_NEAR(found.mean.x * 1.49 / kF, double(b.scene.lights.size()), 1e-5);
    }
    b.quad({-0.5f, 1.4f, -0.5f}, {1, 0, 0}, {0, 0, 1}, b.add(emissive(10)));
    expectMean(estimate(b.scene, kFromAbove, cs184(4)), 0);
}

TEST(Cs184, SurfacesShowTheirFrontSidesLightFromBehind) {
    SceneMaker b = floor();
    b.add(rectangle({0, 1, 0}, {0, -1, 0}));
    EXPECT_NEAR(estimate(b.scene, kFromBelow, cs184(4)).mean.x / kF, 1, 1e-6);
    b.scene.lights = {rectangle({0, -1, 0}, {0, 1, 0})}; // below the normal
    expectMean(estimate(b.scene, kFromBelow, cs184(4)), 0);
}

/// Each light of the file is sampled; where emitters are left to bounces, delta lights are all
/// there is.
TEST(Cs184, EveryLightIsSampledInTurn) {
    SceneMaker b = floor();
    Light point;
    point.position = {0, 4, 3};
    b.add(point);
    b.add(rectangle({0, 2, 0}, {0, -1, 0}));
    RenderSettings s = cs184(4);
    s.estimator.lightChoice = LightChoice::Power; // has nothing to choose
    EXPECT_NEAR(estimate(b.scene, kFromAbove, s).mean.x / (kF * (0.8 + 0.5)), 1, 1e-6);
    s.estimator.directLight = DirectLight::Bsdf;
    expectMean(estimate(b.scene, kFromAbove, s), kF * 0.8);
}

TEST(Cs184, AmbientComesFromAboveOnly) {
    SceneMaker b;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, b.add(diffuse(0.5f)));
    b.scene.lights.emplace_back().kind = LightKind::Ambient;
    expectMean(estimate(b.scene, kFromAbove, cs184(64)), 0.25);
    RenderSettings s = cs184(4);
    s.estimator.directLight = DirectLight::Hemisphere;
    expectMean(estimate(b.scene, kFromAbove, s), 0);
    b.scene.materials[0].kind = MaterialKind::Mirror;
    expectMean(estimate(b.scene, kFromAbove, cs184(4, 5)), 0);
}

TEST(Cs184, EmittersAreNotSampledButSeenByHemisphereAndAfterMirrors) {
    SceneMaker b = floor();
    b.sphere({0, 0, 0}, 20, b.add(emissive(2)));
    expectMean(estimate(b.scene, kFromAbove, cs184(4, 3)), 0);
    RenderSettings s = cs184(64);
    s.estimator.directLight = DirectLight::Bsdf;
    expectMean(estimate(b.scene, kFromAbove, s), 0);
    s.estimator.directLight = DirectLight::Hemisphere;
    expectMean(estimate(b.scene, kFromAbove, s), 0); // no light: no direction
    b.scene.lights.emplace_back();                   // counts, but gives nothing itself
    b.scene.lights.back().position = {0, 4, 0};
    expectMean(estimate(b.scene, kFromAbove, s), 1);
    b.scene.materials[0].kind = MaterialKind::Mirror;
    b.scene.materials[0].reflectance = glm::vec3(0.25f);
    expectMean(estimate(b.scene, kFromAbove, cs184(4)), 0.5);
}

TEST(Cs184, RefractionScalesRadianceTheOtherWay) {
    SceneMaker b;
    b.sphere({0, 0, 0}, 20, b.add(emissive(1)));
    b.sphere({0, 0, 0}, 1, b.add(glass(1.5f)));
    const Camera center = pointCamera({0, 0, 0}, {0, 0, 1}, 0.5);
    b.scene.materials[1].kind = MaterialKind::Refraction;
    expectMean(estimate(b.scene, center, cs184(4, 50)), 1 / 2.25);
    b.scene.materials[1].kind = MaterialKind::Dielectric;
    expectMean(estimate(b.scene, center, cs184(16, 50)), 1 / 2.25);
    const Camera outside = pointCamera({0, 0, 4}, {0, 0, 0}, 0.18);
    expectMean(estimate(b.scene, outside, cs184(16, 50)), 1);
}

} // namespace
} // namespace stromboli
