// Surfaces and cameras in an environment: irradiance by quadrature of a function that this file
// interpolates by itself, and what the camera sees.
#include "tests/analytic/scenes.hpp"

#include "host/core/random.hpp"

#include <glm/gtx/component_wise.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>

namespace stromboli {
namespace {

using namespace test;

const Camera kSeesFloor = pointCamera({1, 2, 3}, {0, 0, 0});

Environment picture(uint32_t width, uint32_t height, const glm::vec3& value) {
    Environment e;
    e.width = width;
    e.height = height;
    e.radiance.assign(size_t(width) * height, value);
    return e;
}

/// Texels that differ a thousandfold, a tenth of them black.
Environment roughPicture(uint32_t width, uint32_t height, uint32_t seed) {
    Environment e = picture(width, height, glm::vec3(0));
    Random random(seed);
    for (glm::vec3& texel : e.radiance)
        if (random.uniform(0, 1) > 0.1f)
            texel = std::pow(10.0f, random.uniform(-2, 1)) *
                    glm::vec3(1, random.uniform(0, 1), random.uniform(0, 1));
    return e;
}

/// At a point of the picture, in texels: between the middles of texels linear, the left edge beside
/// the right one, upper and lower edge repeated.
glm::dvec3 interpolated(const Environment& e, double x, double y) {
    const auto tent = [](double d) { return std::max(0.0, 1 - std::abs(d)); };
    glm::dvec3 sum(0);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const int column = int(std::floor(x)) + dx, row = int(std::floor(y)) + dy;
            const int width = int(e.width), height = int(e.height);
            const size_t index =
                size_t(std::clamp(row, 0, height - 1) * width + (column + width) % width);
            sum += glm::dvec3(e.radiance[index]) * tent(x - column - 0.5) * tent(y - row - 0.5);
        }
    return double(e.strength) * sum;
}

/// The picture's left edge lies at +z; the azimuth grows towards -x. Then turned about y.
glm::dvec3 directionOf(const Environment& e, double x, double y) {
    const double azimuth = 2 * kPi * x / e.width - e.rotation;
    const double polar = kPi * (e.rowsReachPoles ? (y - 0.5) / (e.height - 1) : y / e.height);
    return {-std::sin(polar) * std::sin(azimuth), std::cos(polar),
            std::sin(polar) * std::cos(azimuth)};
}

/// By the midpoint rule on `steps` x `steps` points a texel.
glm::dvec3 irradiance(const Environment& e, const glm::dvec3& normal, int steps = 8) {
    glm::dvec3 sum(0);
    const int rows = int(e.height) - (e.rowsReachPoles ? 1 : 0);
    for (int j = 0; j < rows * steps; ++j)
        for (int i = 0; i < int(e.width) * steps; ++i) {
            const double x = (i + 0.5) / steps, below = (j + 0.5) / steps;
            const double y = below + (e.rowsReachPoles ? 0.5 : 0);
            const double cosine = glm::dot(normal, directionOf(e, x, y));
            if (cosine > 0) sum += interpolated(e, x, y) * cosine * std::sin(kPi * below / rows);
        }
    return sum * (2 * kPi / e.width / steps) * (kPi / rows / steps);
}

Scene floorIn(const Environment& environment, const Material& material = diffuse(0.5f)) {
    SceneMaker b;
    addFloor(b, b.add(material));
    b.scene.environment = environment;
    return b.scene;
}

TEST(EnvironmentLight, OfOneColourLightsAsAmbientLight) {
    for (const uint32_t width : {1u, 8u})
        for (const DirectLight mode : kDirectLightModes) {
            RenderSettings s = smallPicture(64, 1);
            s.estimator.directLight = mode;
            Environment e = picture(width, width == 1 ? 1 : 4, {3, 2, 1});
            e.strength = 2;
            expectMean(estimate(floorIn(e), kSeesFloor, s), glm::dvec3(3, 2, 1));
        }
}

TEST(EnvironmentLight, IrradianceIsThatOfTheInterpolatedPicture) {
    Environment e = roughPicture(16, 8, 1);
    for (const auto& [rotation, rowsReachPoles] :
         {std::pair(0.0f, false), {1.0f, false}, {2.0f, true}}) {
        e.rotation = rotation;
        e.rowsReachPoles = rowsReachPoles;
        for (const DirectLight mode : kDirectLightModes) {
            RenderSettings s = smallPicture(400, 1);
            s.estimator.directLight = mode;
            expectMean(estimate(floorIn(e), kSeesFloor, s),
                       0.5 / kPi * irradiance(e, {0, 1, 0}, 16));
        }
    }
}

TEST(EnvironmentLight, ASingleBrightTexelIsASun) {
    Environment e = picture(64, 32, glm::vec3(0));
    e.radiance[9 * 64 + 20] = {9000, 3000, 500};
    const glm::dvec3 expected = 0.5 / kPi * irradiance(e, {0, 1, 0}, 32);
    // To a hundredth: the mean of its texel, from its middle.
    const double solidAngle = 2 * kPi / 64 * kPi / 32 * std::sin(kPi * 9.5 / 32);
    EXPECT_NEAR(expected.x, 0.5 / kPi * 9000 * solidAngle * std::cos(kPi * 9.5 / 32),
                0.01 * expected.x);
    const Estimate found = estimate(floorIn(e), kSeesFloor, smallPicture(400, 1));
    expectMean(found, expected);
    EXPECT_LT(found.error.x, 0.01 * expected.x) << "samples go where the sun is";
}

TEST(EnvironmentLight, ASunAtThePole) {
    Environment e = picture(16, 8, glm::vec3(0));
    e.radiance[3] = {50, 40, 30};
    e.radiance[7 * 16 + 3] = {900, 900, 900}; // below the floor
    for (const bool rowsReachPoles : {false, true})
        for (const DirectLight mode : {DirectLight::Mis, DirectLight::Lights}) {
            e.rowsReachPoles = rowsReachPoles;
            RenderSettings s = smallPicture(400, 1);
            s.estimator.directLight = mode; // bounces would make up for light samples that miss it
            expectMean(estimate(floorIn(e), kSeesFloor, s),
                       0.5 / kPi * irradiance(e, {0, 1, 0}, 32));
        }
}

TEST(EnvironmentLight, BeginsAtPlusZAndTurnsTowardsMinusX) {
    Environment e = picture(64, 32, glm::vec3(0));
    e.radiance[16 * 64 + 16] = glm::vec3(1000); // a quarter from the left: -x
    SceneMaker b;
    const uint32_t white = b.add(diffuse(1));
    b.quad({-1, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
    b.scene.environment = e;
    const Camera fromTheLeft = pointCamera({-3, 0.1, 0.2}, {-1, 0, 0});
    EXPECT_GT(estimate(b.scene, fromTheLeft, smallPicture(64, 1)).mean.x, 1);
    b.scene.environment->rotation = float(kPi); // to +x, behind the quad
    EXPECT_EQ(estimate(b.scene, fromTheLeft, smallPicture(64, 1)).mean.x, 0);
}

TEST(EnvironmentLight, IsSeenByTheCameraWhereNothingIsInTheWay) {
    Environment e = roughPicture(16, 8, 2);
    e.rotation = 0.7f;
    e.strength = 3;
    // Rows are counted from the zenith.
    for (const auto& [column, below, rowsReachPoles] : {std::tuple(3.3, 1.7, false),
                                                        {0.1, 2.2, false},
                                                        {15.9, 0.3, false},
                                                        {8.0, 3.5, false},
                                                        {15.9, 0.3, true},
                                                        {8.0, 3.1, true}}) {
        e.rowsReachPoles = rowsReachPoles;
        const glm::dvec2 place(column, below + (rowsReachPoles ? 0.5 : 0));
        const Scene scene = floorIn(e);
        const glm::dvec3 d = directionOf(e, place.x, place.y);
        // The direction's place is found to some 1e-5 of a texel, and neighbours differ a
        // thousandfold.
        const glm::dvec3 expected = interpolated(e, place.x, place.y);
        const Estimate found =
            estimate(scene, pointCamera({0, 1, 0}, glm::dvec3(0, 1, 0) + d), smallPicture(1, 2));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.mean[c], expected[c], 3e-3 * glm::compMax(expected)) << place.x;
        RenderSettings bouncesOnly = smallPicture(1, 2);
        bouncesOnly.estimator.minBounce = 1;
        expectMean(estimate(scene, pointCamera({0, 1, 0}, glm::dvec3(0, 1, 0) + d), bouncesOnly),
                   0);
    }
}

TEST(EnvironmentLight, IsSeenInAMirror) {
    Environment e = roughPicture(16, 8, 3);
    SceneMaker b;
    addFloor(b, b.add(mirror(0.5f)));
    b.scene.environment = e;
    const glm::dvec3 up = directionOf(e, 5.3, 2.4);
    const Camera camera = pointCamera(glm::dvec3(-up.x, up.y, -up.z), {0, 0, 0});
    const glm::dvec3 expected = interpolated(e, 5.3, 2.4) * 0.5;
    const Estimate found = estimate(b.scene, camera, smallPicture(1, 2));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c], 3e-3 * glm::compMax(expected));
}

/// Beside other lights one of all is picked: their sum is what arrives.
TEST(EnvironmentLight, AddsToOtherLights) {
    const Environment e = roughPicture(16, 8, 4);
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.5f)));
    b.quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, b.add(emissive(4)));
    Light point;
    point.kind = LightKind::Point;
    point.position = {0, 2, 1.5f};
    point.color = {3, 2, 1};
    b.add(point);
    const RenderSettings s = smallPicture(400, 1);
    const Estimate without = estimate(b.scene, kSeesFloor, s);
    b.scene.environment = e;
    // The quad hides a part of the environment: seen by bounces and by light samples alike.
    RenderSettings byBounces = s;
    byBounces.estimator.directLight = DirectLight::Bsdf;
    byBounces.estimator.seed = 2;
    const Estimate both = estimate(b.scene, kSeesFloor, s);
    EXPECT_GT(both.mean.x, without.mean.x);
    expectSameMean(both, estimate(b.scene, kSeesFloor, byBounces));
}

} // namespace
} // namespace stromboli
