// hitSphere of intersect.glsl against double precision.
#include "host/core/random.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/hit_sphere_shader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

using gpu::SphereAnswer;
using gpu::SphereQuery;

bool hits(float t) {
    return t > 0 && t < kInfinite;
}

struct SphereTruth {
    double across = 0;        ///< distance of the line to the centre
    double near = 0, far = 0; ///< t of both hits; of the closest approach if there is none
};

SphereTruth truth(const SphereQuery& q) {
    const glm::dvec3 o(q.origin), d(q.direction), f = o - glm::dvec3(q.center);
    const double length = glm::length(d), closest = -glm::dot(f, d) / (length * length);
    const double across = glm::length(glm::cross(f, d)) / length, r = q.radius;
    const double half = std::sqrt(std::max((r - across) * (r + across), 0.0)) / length;
    return {across, closest - half, closest + half};
}

class HitSphere : public DeviceTest {
  protected:
    std::vector<SphereAnswer> answers(const std::vector<SphereQuery>& queries) {
        return ask<SphereAnswer>(hit_sphere_shader, queries);
    }
};

enum class From { Anywhere, AlongAnAxis };

/// Rays from `distance` away at a square of 4 radii about the sphere. As shadow rays: the
/// direction is the difference of two points. Far along an axis the coordinates across it stay
/// exact; elsewhere the points are on a grid of 2^-23 of the distance, whatever the test does.
std::vector<SphereQuery> farRays(float distance, float radius, From from, int n, Random& random) {
    std::vector<SphereQuery> queries;
    for (int i = 0; i < n; ++i) {
        glm::vec3 axis(0.0f), side(0.0f);
        if (from == From::AlongAnAxis) {
            axis[i % 3] = i & 1 ? 1.0f : -1.0f;
            side[(i + 1) % 3] = 1;
        } else {
            axis = glm::normalize(random.vector());
            side = glm::normalize(glm::cross(axis, random.vector()));
        }
        const glm::vec3 center = radius * random.inCube(1);
        const glm::vec3 target = center + radius * random.uniform(-2, 2) * side +
                                 radius * random.uniform(-2, 2) * glm::cross(axis, side);
        const glm::vec3 start = center + radius * random.inCube(1);
        const glm::vec3 origin = (from == From::AlongAnAxis ? start : target) - distance * axis;
        queries.push_back({center, radius, origin, 0, target - origin, kInfinite});
    }
    return queries;
}

TEST_F(HitSphere, HitFractionOfASmallSphereFarAway) {
    constexpr int kRays = 100000;
    Random random(41);
    for (const auto& [distance, from] : {std::pair{1e2f, From::Anywhere},
                                         {1e3f, From::Anywhere},
                                         {1e4f, From::Anywhere},
                                         {1e5f, From::AlongAnAxis},
                                         {1e6f, From::AlongAnAxis}}) {
        const std::vector<SphereQuery> queries = farRays(distance, 0.1f, from, kRays, random);
        const std::vector<SphereAnswer> found = answers(queries);
        int hit = 0, naive = 0;
        for (const SphereAnswer& a : found) {
            hit += hits(a.t);
            naive += hits(a.naive);
        }
        // The share of a disc in its square of 4 radii.
        const double share = 3.14159265358979 / 16, sigma = std::sqrt(kRays * share * (1 - share));
        EXPECT_NEAR(hit, kRays * share, 3 * sigma) << distance;
        if (distance > 4096 * 0.1) {
            EXPECT_GT(std::abs(naive - kRays * share), 3 * sigma)
                << "negative control: b^2 - 4ac has no correct digit at " << distance;
        }
    }
}

/// Not only the share: each ray, but those within the rounding of coordinates.
TEST_F(HitSphere, DecidesAsDoublePrecisionDoes) {
    Random random(42);
    for (const float radius : {1e-6f, 0.1f, 1e6f})
        for (const auto& [ratio, from] : {std::pair{0.5f, From::Anywhere},
                                          {3.0f, From::Anywhere},
                                          {1e2f, From::Anywhere},
                                          {1e4f, From::Anywhere},
                                          {1e4f, From::AlongAnAxis},
                                          {1e6f, From::AlongAnAxis}}) {
            const std::vector<SphereQuery> queries =
                farRays(ratio * radius, radius, from, 20000, random);
            const std::vector<SphereAnswer> found = answers(queries);
            int hit = 0;
            for (size_t i = 0; i < queries.size(); ++i) {
                const SphereTruth expected = truth(queries[i]);
                const double length = glm::length(glm::dvec3(queries[i].direction));
                // Across the line: roundings of coordinates of some radii, and where the origin
                // is not on an axis that of its distance to the centre.
                const double far = from == From::Anywhere ? 2.0 * ratio : 0.0;
                const double across = (24 + far) * kRoundoff * radius;
                const double along = 12 * kRoundoff * (ratio + 2) * radius;
                const double nearest =
                    std::min(std::abs(expected.near), std::abs(expected.far)) * length;
                if (std::abs(expected.across - radius) < across || nearest < along) continue;
                const bool inside = expected.across < radius && expected.far > 0;
                ASSERT_EQ(hits(found[i].t), inside) << radius << ' ' << ratio << ' ' << i;
                if (!inside) continue;
                ++hit;
                const double t = expected.near > 0 ? expected.near : expected.far;
                ASSERT_NEAR(found[i].t * length, t * length, std::sqrt(2 * radius * across) + along)
                    << radius << ' ' << ratio << ' ' << i;
            }
            EXPECT_GT(hit, 2000) << radius << ' ' << ratio;
        }
}

TEST_F(HitSphere, FromInsideTheMiddleAndTheSurface) {
    Random random(43);
    std::vector<SphereQuery> queries;
    for (int i = 0; i < 3000; ++i) {
        const float radius = i % 2 ? 1e-3f : 10.0f;
        const glm::vec3 d = random.vector();
        const glm::vec3 inside = 0.3f * radius * random.inCube(1);
        queries.push_back({{0, 0, 0}, radius, inside, 0, d, kInfinite});
        queries.push_back({{0, 0, 0}, radius, {0, 0, 0}, 0, d, kInfinite});
    }
    const std::vector<SphereAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const double far = truth(queries[i]).far;
        EXPECT_NEAR(found[i].t / far, 1, 12 * kRoundoff) << i;
    }
    const std::vector<SphereAnswer> fixed = answers({
        {{0, 0, 0}, 1, {0, 0, -1}, 0, {0, 0, 1}, 10},  // on it, through it
        {{0, 0, 0}, 1, {0, 0, -1}, 0, {0, 0, -1}, 10}, // on it, away
        {{0, 0, 0}, 1, {1, 0, -3}, 0, {0, 0, 1}, 10},  // tangent
        {{0, 0, 0}, 1, {0, 0, 3}, 0, {0, 0, 1}, 10},   // behind
    });
    EXPECT_EQ(fixed[0].t, 2);
    EXPECT_FALSE(hits(fixed[1].t));
    EXPECT_EQ(fixed[2].t, 3);
    EXPECT_FALSE(hits(fixed[3].t));
}

TEST_F(HitSphere, RespectsTheOpenInterval) {
    const auto ask1 = [&](float tMin, float tMax) {
        return answers({{{0, 0, 0}, 1, {0, 0, -3}, tMin, {0, 0, 1}, tMax}})[0].t;
    };
    EXPECT_EQ(ask1(0, 10), 2);
    EXPECT_EQ(ask1(2, 10), 4);
    EXPECT_EQ(ask1(2, 4), kInfinite);
    EXPECT_EQ(ask1(0, 2), kInfinite);
    EXPECT_EQ(ask1(4, 10), kInfinite);
}

} // namespace
} // namespace stromboli::test
