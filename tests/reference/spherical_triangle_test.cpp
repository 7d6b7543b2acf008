// Arvo's sampling against the octant, Lambert's formula and the sphere as a whole.
#include "host/reference/sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::reference {
namespace {

glm::dvec3 randomDirection(RandomStream& random) {
    const double u = random.next(), v = random.next();
    return uniformSphere(u, v);
}

TEST(SphericalTriangle, OctantIsAnEighthOfTheSphere) {
    EXPECT_NEAR(SphericalTriangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}).solidAngle(), kPi / 2, 1e-14);
    EXPECT_NEAR(SphericalTriangle({1, 0, 0}, {0, 0, 1}, {0, 1, 0}).solidAngle(), kPi / 2, 1e-14);
}

/// The vector irradiance of a triangle of radiance 1 is half the sum of its arcs times their
/// normals (Lambert): the integral of directions, which is what the samples' mean has to be.
TEST(SphericalTriangle, SamplesHaveTheMeanOfTheTriangle) {
    constexpr int kSamples = 20000;
    for (uint32_t i = 0; i < 12; ++i) {
        RandomStream random(i, 0, 31);
        glm::dvec3 corners[3];
        const glm::dvec3 center = randomDirection(random);
        for (glm::dvec3& c : corners) // of all sizes down to .003 rad
            c = glm::normalize(center + std::exp2(-0.75 * i) * randomDirection(random));
        const SphericalTriangle triangle(corners[0], corners[1], corners[2]);
        glm::dvec3 expected(0.0), sum(0.0), squares(0.0);
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 c = glm::cross(corners[k], corners[(k + 1) % 3]);
            const double sine = glm::length(c);
            expected +=
                0.5 * std::atan2(sine, glm::dot(corners[k], corners[(k + 1) % 3])) * (c / sine);
        }
        if (glm::dot(expected, center) < 0) expected = -expected;
        const double inside =
            std::copysign(1, glm::dot(corners[0], glm::cross(corners[1], corners[2])));
        for (int s = 0; s < kSamples; ++s) {
            const double u = random.next(), v = random.next();
            const glm::dvec3 w = triangle.sample(u, v);
            ASSERT_NEAR(glm::length(w), 1, 1e-7);
            for (int k = 0; k < 3; ++k)
                ASSERT_GT(inside * glm::dot(w, glm::cross(corners[k], corners[(k + 1) % 3])),
                          -1e-9);
            sum += w * triangle.solidAngle();
            squares += w * w * triangle.solidAngle() * triangle.solidAngle();
        }
        const glm::dvec3 mean = sum / double(kSamples);
        const glm::dvec3 variance = squares / double(kSamples) - mean * mean;
        for (int k = 0; k < 3; ++k) // 36 tests at 4.5 sigma
            EXPECT_NEAR(mean[k], expected[k],
                        4.5 * std::sqrt(std::max(variance[k], 0.0) / kSamples) + 1e-8)
                << i;
    }
}

} // namespace
} // namespace stromboli::reference
