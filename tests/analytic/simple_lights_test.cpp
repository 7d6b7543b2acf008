// Delta lights and ambient light over a diffuse floor of albedo 0.5: radiance = 0.5 / pi times the
// irradiance, which has a closed form.
#include "tests/analytic/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

constexpr double kFloor = 0.5 / kPi; ///< BSDF of the floor

const Camera kSeesLitFloor = pointCamera({1, 2, 3}, {0, 0, 0});

Scene floorUnder(const Light& light) {
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.5f)));
    b.add(light);
    return b.scene;
}

/// At (0, 2, 1.5): distance 2.5, cosine to the floor 0.8.
Light lightAbove(LightKind kind) {
    Light light;
    light.kind = kind;
    light.color = {3, 2, 1};
    light.position = {0, 2, 1.5f};
    light.direction = {0, -0.8f, -0.6f};
    return light;
}

TEST(SimpleLights, Point) {
    Light light = lightAbove(LightKind::Point);
    light.constantAttenuation = 0.5f, light.linearAttenuation = 0.25f,
    light.quadraticAttenuation = 2;
    const double irradiance = 0.8 / (0.5 + 0.25 * 2.5 + 2 * 2.5 * 2.5);
    for (DirectLight mode : kDirectLightModes) {
        RenderSettings s = smallPicture(1, 1);
        s.estimator.directLight = mode;
        expectMean(estimate(floorUnder(light), kSeesLitFloor, s),
                   kFloor * irradiance * glm::dvec3(3, 2, 1));
    }
}

TEST(SimpleLights, PointBehindTheFloorGivesNothing) {
    Light light = lightAbove(LightKind::Point);
    light.position.y = -2;
    expectMean(estimate(floorUnder(light), kSeesLitFloor, smallPicture(1, 1)), 0);
}

TEST(SimpleLights, TwoSidedFloorIsLitFromBelow) {
    Light light = lightAbove(LightKind::Point);
    light.position.y = -2;
    const Camera below = pointCamera({1, -2, 3}, {0, 0, 0});
    expectMean(estimate(floorUnder(light), below, smallPicture(1, 1)),
               kFloor * 0.8 * glm::dvec3(3, 2, 1));
}

TEST(SimpleLights, Shadow) {
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.5f)));
    b.sphere({0, 1, 0.75f}, 0.1f, 0);
    b.add(lightAbove(LightKind::Point));
    expectMean(estimate(b.scene, kSeesLitFloor, smallPicture(1, 1)), 0);
    // The sphere beyond the light does not shade it.
    b.scene.spheres[0].center = {0, 4, 3};
    expectMean(estimate(b.scene, kSeesLitFloor, smallPicture(1, 1)),
               kFloor * 0.8 * glm::dvec3(3, 2, 1));
}

TEST(SimpleLights, Directional) {
    const Light light = lightAbove(LightKind::Directional);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(light.direction));
    expectMean(estimate(floorUnder(light), kSeesLitFloor, smallPicture(1, 1)),
               kFloor * -axis.y * glm::dvec3(3, 2, 1));
}

TEST(SimpleLights, Spot) {
    Light light = lightAbove(LightKind::Spot);
    light.direction = {0, -1, 0}; // the floor point is off the axis by acos 0.8 = 36.87 degrees
    light.falloffExponent = 3;
    light.falloffAngle = float(74 * kPi / 180);
    const double lit = kFloor * 0.8 * std::pow(0.8, 3);
    expectMean(estimate(floorUnder(light), kSeesLitFloor, smallPicture(1, 1)),
               lit * glm::dvec3(3, 2, 1));
    light.falloffAngle = float(73 * kPi / 180);
    expectMean(estimate(floorUnder(light), kSeesLitFloor, smallPicture(1, 1)), 0);
}

/// Between the cones of KHR_lights_punctual (glTF 2.0), 36.87 degrees off the axis.
TEST(SimpleLights, SpotWithSoftEdge) {
    Light light = lightAbove(LightKind::Spot);
    light.direction = {0, -1, 0};
    light.falloffAngle = float(120 * kPi / 180);
    light.innerAngle = float(60 * kPi / 180);
    // Cosines of the angles as they are rounded: nearly 0.5 and sqrt(0.75).
    const double outer = std::cos(double(light.falloffAngle) / 2);
    const double inner = std::cos(double(*light.innerAngle) / 2);
    const double edge = (0.8 - outer) / (inner - outer);
    expectMean(estimate(floorUnder(light), kSeesLitFloor, smallPicture(1, 1)),
               kFloor * 0.8 * edge * edge * glm::dvec3(3, 2, 1));
    light.innerAngle = float(74 * kPi / 180);
    expectMean(estimate(floorUnder(light), kSeesLitFloor, smallPicture(1, 1)),
               kFloor * 0.8 * glm::dvec3(3, 2, 1));
}

TEST(SimpleLights, AmbientFromAllSidesInEveryMode) {
    Light light;
    light.kind = LightKind::Ambient;
    light.color = {3, 2, 1};
    for (DirectLight mode : kDirectLightModes) {
        RenderSettings s = smallPicture(64, 1);
        s.estimator.directLight = mode;
        expectMean(estimate(floorUnder(light), kSeesLitFloor, s), 0.5 * glm::dvec3(3, 2, 1));
    }
}

TEST(SimpleLights, UpperHemisphereLightsHalfOfAWall) {
    SceneMaker b;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, b.add(diffuse(0.5f)));
    Light light;
    light.kind = LightKind::Ambient;
    light.upperHemisphereOnly = true;
    b.add(light);
    for (DirectLight mode : kDirectLightModes) {
        RenderSettings s = smallPicture(64, 1);
        s.estimator.directLight = mode;
        expectMean(estimate(b.scene, kSeesLitFloor, s), 0.25);
    }
}

/// Ambient light is the first in the kernel's buffer of lights, sampled or not.
TEST(SimpleLights, OthersBesideAmbientLight) {
    for (const size_t points : {1, 2}) {
        SceneMaker b = SceneMaker();
        addFloor(b, b.add(diffuse(0.5f)));
        for (size_t i = 0; i < points; ++i) {
            b.add(lightAbove(LightKind::Point));
            b.scene.lights.back().quadraticAttenuation = 1;
            b.scene.lights.back().constantAttenuation = 0;
        }
        b.scene.lights.emplace_back().kind = LightKind::Ambient;
        const glm::dvec3 ofPoint = kFloor * (0.8 / (2.5 * 2.5)) * glm::dvec3(3, 2, 1);
        for (DirectLight mode : kDirectLightModes) {
            SCOPED_TRACE(fmt::format("{} {}", nameOf(mode), points));
            RenderSettings s = smallPicture(64, 1);
            s.estimator.directLight = mode;
            expectMean(estimate(b.scene, kSeesLitFloor, s), 0.5 + double(points) * ofPoint);
            // Nothing is scattered twice.
            s.estimator.minBounce = s.estimator.maxBounces = 2;
            expectMean(estimate(b.scene, kSeesLitFloor, s), 0);
        }
    }
}

TEST(SimpleLights, AmbientIsNoBackdrop) {
    Scene empty;
    empty.lights.emplace_back().kind = LightKind::Ambient;
    for (DirectLight mode : kDirectLightModes) {
        RenderSettings s = smallPicture(1, 5);
        s.estimator.directLight = mode;
        expectMean(estimate(empty, kSeesLitFloor, s), 0);
    }
}

TEST(SimpleLights, MirrorShowsAmbientLightWithoutDirectLight) {
    SceneMaker b;
    Material mirror;
    mirror.kind = MaterialKind::Mirror;
    mirror.reflectance = glm::vec3(0.25f);
    addFloor(b, b.add(mirror));
    b.add(lightAbove(LightKind::Point));
    b.scene.lights.emplace_back().kind = LightKind::Ambient;
    for (DirectLight mode : kDirectLightModes) {
        RenderSettings s = smallPicture(1, 1);
        s.estimator.directLight = mode;
        expectMean(estimate(b.scene, kSeesLitFloor, s), 0.25);
    }
}

} // namespace
} // namespace stromboli
