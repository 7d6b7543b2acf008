// Samples of sphere lights from outside, inside, and the sphere itself.
#include "tests/shaders/light_fixture.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

using gpu::LightAnswer;
using gpu::LightQuery;

constexpr size_t kSphereSamples = 40000;

Scene sphereEmitter(const glm::vec3& center, float radius, bool bothSides) {
    Scene scene = sceneWithEmitter({1, 2, 4}, bothSides);
    Sphere s;
    s.center = center;
    s.radius = radius;
    s.material = 1;
    scene.spheres.push_back(s);
    return scene;
}

struct SphereCase {
    float radius, distance; ///< distance to the centre, in radii
};

class SphereLight : public LightFixture, public ::testing::WithParamInterface<SphereCase> {};

TEST_P(SphereLight, FromOutsideUniformlyInTheCone) {
    const auto [radius, ratio] = GetParam();
    Random random(131);
    const glm::vec3 center = radius * random.inCube(1);
    const glm::vec3 away = glm::normalize(random.vector());
    setScene(sphereEmitter(center, radius, false));
    LightQuery surface = surfaceAt(center + ratio * radius * away, -away);
    surface.error = glm::vec3(0.0f); // the point is where it is, as near to the sphere as it is
    const std::vector<LightAnswer> found = answers(samples(surface, kSphereSamples, 132));

    const glm::dvec3 to = glm::dvec3(center) - glm::dvec3(surface.position);
    const double distance = glm::length(to), sine2 = std::pow(double(radius) / distance, 2);
    const double oneMinusCosMax = sine2 / (1 + std::sqrt(1 - sine2));
    const glm::dvec3 axis = to / distance;
    const glm::dvec3 x = glm::normalize(glm::cross(axis, glm::dvec3(0.36, 0.48, 0.8)));
    const glm::dvec3 y = glm::cross(axis, x);
    constexpr size_t kGrid = 8;
    std::vector<double> counts(kGrid * kGrid);
    double irradiance = 0;
    for (const LightAnswer& a : found) {
        ASSERT_TRUE(isSound(a));
        const glm::dvec3 w = glm::normalize(glm::dvec3(a.direction));
        const double cosine = glm::dot(w, axis);
        const double across2 = std::pow(glm::dot(w, x), 2) + std::pow(glm::dot(w, y), 2);
        const double share = across2 / (1 + cosine) / oneMinusCosMax; // of 1 - cos
        ASSERT_LT(share, 1 + 1e-5 + 4e-7 * ratio);
        const double turn = std::atan2(glm::dot(w, y), glm::dot(w, x)) / (2 * kPi) + 0.5;
        ++counts[std::min(size_t(share * kGrid), kGrid - 1) * kGrid +
                 std::min(size_t(turn * kGrid), kGrid - 1)];
        // L / pdf, pdf = 1 / (2 pi (1 - cos_max)).
        ASSERT_NEAR(a.radiance.y / (2 * 2 * kPi * oneMinusCosMax), 1, 1e-5 / std::sqrt(1 - sine2));
        ASSERT_EQ(a.blocked, 0u) << "the emitter shades itself";
        irradiance += a.radiance.x * cosine / double(kSphereSamples);
    }
    EXPECT_GT(chiSquareTest(counts, std::vector<double>(counts.size(), double(kSphereSamples) /
                                                                           double(counts.size()))),
              sidakLevel(0.01, 7));
    // A sphere facing a surface gives E = pi L (r / d)^2. cos is uniform in [cosMax, 1].
    const double sigma =
        oneMinusCosMax / std::sqrt(12.0 * kSphereSamples) * 2 * kPi * oneMinusCosMax;
    EXPECT_NEAR(irradiance, kPi * sine2, 4 * sigma + 1e-5 * kPi * sine2);
    for (const LightAnswer& a : answers(ends(surface)))
        EXPECT_TRUE(isSound(a));
}

INSTANTIATE_TEST_SUITE_P(Distances, SphereLight,
                         ::testing::Values(SphereCase{1, 1.01f}, SphereCase{1, 1.5f},
                                           SphereCase{1e-6f, 3}, SphereCase{1e6f, 3},
                                           SphereCase{0.1f, 100}, SphereCase{0.1f, 1e4f},
                                           SphereCase{0.1f, 1e5f}),
                         [](const auto& one) {
                             return test::testName(fmt::format(
                                 "radius {} at {} radii", one.param.radius, one.param.distance));
                         });

class SphereLightInside : public LightFixture {};

TEST_F(SphereLightInside, UniformlyOnTheArea) {
    const glm::vec3 center(3, -2, 1);
    const float radius = 2;
    for (const bool bothSides : {false, true}) {
        setScene(sphereEmitter(center, radius, bothSides));
        const LightQuery surface = surfaceAt(center + glm::vec3(0.5f, 1, -0.75f), {0, 1, 0});
        std::vector<double> heights(16);
        double irradiance = 0, squares = 0;
        for (const LightAnswer& a : answers(samples(surface, kSphereSamples, 133))) {
            ASSERT_TRUE(isSound(a));
            ASSERT_EQ(a.radiance.x > 0, bothSides);
            ASSERT_EQ(a.blocked, 0u);
            // Where the direction leaves the sphere.
            const glm::dvec3 f = glm::dvec3(surface.position) - glm::dvec3(center), w(a.direction);
            const double b = glm::dot(f, w), r = radius;
            const double d = -b + std::sqrt(b * b - glm::dot(f, f) + r * r);
            const glm::dvec3 n = (f + d * w) / r;
            ++heights[std::min(size_t((n.z + 1) * 8), size_t(15))];
            if (!bothSides) continue;
            const double expected = 4 * kPi * r * r * glm::dot(n, w) / (d * d);
            ASSERT_NEAR(a.radiance.x / expected, 1, 1e-5);
            const double value = a.radiance.x * std::max(double(a.direction.y), 0.0);
            irradiance += value / double(kSphereSamples),
                squares += value * value / double(kSphereSamples);
        }
        // By Archimedes, heights on a sphere are uniform.
        EXPECT_GT(chiSquareTest(heights, std::vector<double>(16, double(kSphereSamples) / 16)),
                  0.005);
        const double sigma =
            std::sqrt((squares - irradiance * irradiance) / double(kSphereSamples));
        EXPECT_NEAR(irradiance, bothSides ? kPi : 0, 4 * sigma) << "radiance 1 all around";
        for (const LightAnswer& a : answers(ends(surface)))
            EXPECT_TRUE(isSound(a));
    }
}

/// Surfaces that are the sphere itself: outside it lights nothing of itself; from within it is
/// seen all over, whatever rounding has done to the point: a sample weighs L A cos cos / d^2, on
/// a sphere's own points pi L. Up to 1000 radii from the origin of coordinates; near 10^4 the
/// rounding across the normal, squared, outgrows the bound along it.
TEST_F(SphereLightInside, PointsOfTheSphereItself) {
    Random random(134);
    for (const float radius : {1e-3f, 1.0f, 50.0f})
        for (const bool bothSides : {false, true}) {
            const glm::vec3 center = 1000.0f * radius * random.inCube(1);
            setScene(sphereEmitter(center, radius, bothSides));
            std::vector<LightQuery> inside, outside;
            for (int i = 0; i < 20000; ++i) {
                const glm::vec3 n = glm::normalize(random.vector());
                LightQuery q = surfaceAt(center + radius * n, n);
                q.error = glm::vec3(16 * 0x1p-24f * radius) + 4 * 0x1p-24f * glm::abs(center);
                q.u = random.uniform(), q.v = random.uniform();
                outside.push_back(q);
                q.outside = 0; // faced forward to a viewer within
                q.geometric = q.shading = q.wo = -n;
                inside.push_back(q);
            }
            const std::vector<LightAnswer> fromWithin = answers(inside);
            double sum = 0;
            uint32_t blocked = 0;
            for (size_t i = 0; i < inside.size(); ++i) {
                const LightAnswer& a = fromWithin[i];
                ASSERT_TRUE(bothSides || a.radiance == glm::vec3(0.0f))
                    << radius << ' ' << i << ": light from the dark inside of an emitter";
                const double cosine =
                    glm::dot(glm::dvec3(a.direction), glm::dvec3(inside[i].shading));
                sum += a.radiance.x * std::max(cosine, 0.0) / double(inside.size());
                blocked += a.blocked;
            }
            EXPECT_NEAR(sum, bothSides ? kPi : 0, 0.01) << radius;
            EXPECT_EQ(blocked, 0u) << radius;
            const std::vector<LightAnswer> fromOutside = answers(outside);
            for (size_t i = 0; i < outside.size(); ++i) {
                const double cosine =
                    glm::dot(glm::dvec3(fromOutside[i].direction), glm::dvec3(outside[i].shading));
                const double own = std::sqrt(2 * 40 * 0x1p-24 * 1000); // horizon
                ASSERT_TRUE(cosine < own || fromOutside[i].radiance.x == 0) << radius << ' ' << i;
            }
        }
}

} // namespace
} // namespace stromboli::test
