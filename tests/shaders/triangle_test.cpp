// hitTrianglePair of intersect.glsl against plane equations in double precision.
#include "host/core/random.hpp"
#include "tests/bvh/oracle.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/hit_triangle_shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli::test {
namespace {

using gpu::TriangleAnswer;
using gpu::TriangleQuery;

constexpr double kUlp = 0x1p-23;

TriangleQuery query(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2,
                    const glm::vec3& origin, const glm::vec3& direction) {
    return {v0, 0, v1, 0, v2, 0, origin, 0, direction, 0};
}

TriangleTruth truth(const TriangleQuery& q) {
    return intersectInDouble(q.v0, q.v1, q.v2, q.origin, q.direction);
}

/// What the traversal takes for a hit.
bool isHit(float t) {
    return t > 0 && t < kInfinite;
}

class HitTriangle : public DeviceTest {
  protected:
    /// A triangle is hit alike in either slot of a leaf; a slot without area is not hit.
    std::vector<TriangleAnswer> answers(const std::vector<TriangleQuery>& queries) {
        const auto found = ask<TriangleAnswer>(hit_triangle_shader, queries);
        for (size_t i = 0; i < found.size(); ++i) {
            const TriangleAnswer& a = found[i];
            EXPECT_FALSE(isHit(a.t2)) << i;
            EXPECT_EQ(isHit(a.t1), isHit(a.t)) << i;
            const bool same = a.t1 == a.t && a.b11 == a.b1 && a.b21 == a.b2;
            EXPECT_TRUE(same || !isHit(a.t)) << i;
        }
        return found;
    }
};

/// A right-angled triangle with legs `size` near the origin, turned at random, and a ray from
/// about `size` away through a point well inside it, at less than 60 degrees to its normal.
TriangleQuery wellConditioned(float size, Random& random) {
    for (;;) {
        const glm::vec3 v0 = size * random.inCube(1);
        const glm::vec3 e = glm::normalize(random.vector());
        const glm::vec3 f = glm::normalize(glm::cross(e, random.vector()));
        const glm::vec3 v1 = v0 + size * e, v2 = v0 + size * f;
        const float b1 = random.uniform(0.1f, 0.8f), b2 = random.uniform(0.1f, 0.9f - b1);
        const glm::vec3 target = v0 + b1 * (v1 - v0) + b2 * (v2 - v0);
        const glm::vec3 origin = size * random.inCube(2);
        const glm::vec3 direction = random.uniform(0.5f, 2.0f) * glm::normalize(target - origin);
        const float slope = glm::dot(glm::normalize(direction), glm::cross(e, f));
        if (std::abs(slope) > 0.5f && glm::distance(target, origin) > 0.5f * size)
            return query(v0, v1, v2, origin, direction);
    }
}

/// Legs, coordinates and distances alike: 16 ulp (Embree's figure for its own test). In units of
/// 2^-24 a corner carries 1 for the difference to the origin, 5 for the shear and 1 for
/// subtracting it, relative to coordinates of up to 4 legs; divided by a height of at least 1/2 and
/// the slope this would allow 100; what is seen is below a tenth of that.
TEST_F(HitTriangle, WeightsAndDistanceOfTrianglesOfAnySize) {
    Random random(31);
    for (const float size : {1e-12f, 1e-6f, 2e-4f, 1.0f, 1e6f, 1e9f}) {
        std::vector<TriangleQuery> queries;
        for (int i = 0; i < 4000; ++i)
            queries.push_back(wellConditioned(size, random));
        const std::vector<TriangleAnswer> found = answers(queries);
        double worst = 0;
        for (size_t i = 0; i < queries.size(); ++i) {
            const TriangleTruth expected = truth(queries[i]);
            ASSERT_TRUE(isHit(found[i].t)) << size << ' ' << i;
            worst = std::max({worst, std::abs(found[i].t / expected.t - 1),
                              std::abs(found[i].b1 - expected.weights[1]),
                              std::abs(found[i].b2 - expected.weights[2])});
        }
        EXPECT_LT(worst, 16 * kUlp) << size;
    }
}

TEST_F(HitTriangle, TinyOnesFromAfarWhereACutOffLosesThem) {
    std::vector<TriangleQuery> queries;
    for (const float size : {2e-4f, 1e-6f, 1e-12f}) {
        const glm::vec3 a(0, 0, 0), b(size, 0, 0), c(0, size, 0);
        queries.push_back(query(a, b, c, (a + b + c) / 3.0f + glm::vec3(0, 0, 1), {0, 0, -1}));
        queries.push_back(query(a, b, c, {1, 2, 3}, (a + b + c) / 3.0f - glm::vec3(1, 2, 3)));
    }
    const std::vector<TriangleAnswer> found = answers(queries);
    // From (1, 2, 3) at something of 1e-6 the rounded direction passes by.
    for (size_t i : {0u, 1u, 2u, 4u}) {
        EXPECT_NEAR(found[i].t, 1, 4 * kUlp) << i;
        EXPECT_NEAR(found[i].b1, 1.0 / 3, i == 1 ? 0.01 : 4 * kUlp) << i;
    }
    EXPECT_TRUE(isHit(found[0].naive)) << "2e-4 is above the cut-off";
    for (size_t i : {2u, 4u})
        EXPECT_FALSE(isHit(found[i].naive)) << "negative control: the cut-off loses it";
}

TEST_F(HitTriangle, DecidesAsDoublePrecisionDoes) {
    Random random(32);
    std::vector<TriangleQuery> queries;
    for (int i = 0; i < 300000; ++i) {
        const glm::vec3 a = random.inCube(1), b = random.inCube(1), c = random.inCube(1);
        queries.push_back(query(a, b, c, random.inCube(2), random.vector()));
    }
    const std::vector<TriangleAnswer> found = answers(queries);
    // Corners in the sheared plane carry 6 roundings or so of coordinates up to 6.
    constexpr double kMargin = 40 * 0x1p-24;
    int hit = 0, missed = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const TriangleTruth expected = truth(queries[i]);
        if (std::abs(expected.margin) < kMargin || std::abs(expected.t) < 1e-3) continue;
        const bool inside = expected.margin > 0 && expected.t > 0;
        ASSERT_EQ(isHit(found[i].t), inside) << i;
        ++(inside ? hit : missed);
    }
    EXPECT_GT(hit, 3000);
    EXPECT_GT(missed, 100000);
}

TEST_F(HitTriangle, DirectionsWithZerosAreAsGoodAsAnyOther) {
    Random random(33);
    std::vector<TriangleQuery> queries;
    for (int i = 0; i < 6000; ++i) {
        const int axis = i % 3;
        glm::vec3 direction(i & 1 ? 0.0f : -0.0f), target = random.inCube(1);
        direction[axis] = random.below(2) ? 1.0f : -1.0f;
        if (i & 2) direction[(axis + 1) % 3] = random.uniform(-1, 1);
        const glm::vec3 a = target + random.inCube(1), b = target + random.inCube(1);
        queries.push_back(query(a, b, 3.0f * target - a - b, target - 2.0f * direction, direction));
    }
    const std::vector<TriangleAnswer> found = answers(queries);
    int hit = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const TriangleTruth expected = truth(queries[i]);
        if (expected.margin < 1e-3) continue;
        ++hit;
        EXPECT_NEAR(found[i].t, expected.t, 1e-3) << i;
    }
    EXPECT_GT(hit, 5000);
}

TEST_F(HitTriangle, WithoutAreaIsNeverHit) {
    Random random(34);
    std::vector<TriangleQuery> queries;
    for (int i = 0; i < 30000; ++i) {
        const glm::vec3 a = random.inCube(1), b = random.inCube(1);
        const glm::vec3 target = a + random.uniform() * (b - a), origin = random.inCube(2);
        const glm::vec3 corners[] = {a, a, b, b, a, a}; // two or three of them equal
        const uint32_t k = random.below(4);
        queries.push_back(query(corners[k], corners[k + 1], corners[k + 2], origin,
                                random.below(2) ? target - origin : random.vector()));
        // Collinear, exactly so: halves, in a plane of the axes, hit head on.
        const glm::vec3 c(random.below(64), random.below(64), 0), d(random.below(64), 64, 0);
        const glm::vec3 middle = 0.5f * (c + d);
        queries.push_back(query(c, middle, d, middle + glm::vec3(0, 0, 5), {0, 0, -1}));
    }
    const std::vector<TriangleAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i)
        ASSERT_FALSE(isHit(found[i].t)) << i;
}

TEST_F(HitTriangle, SeenEdgeOnIsNeverHit) {
    Random random(35);
    std::vector<TriangleQuery> queries;
    for (int i = 0; i < 30000; ++i) {
        glm::vec3 p[5];
        for (glm::vec3& v : p) {
            v = random.inCube(1);
            v[i % 3] = 0.25f;
        }
        p[4][i % 3] = 0; // direction
        queries.push_back(query(p[0], p[1], p[2], p[3], p[4]));
    }
    const std::vector<TriangleAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i)
        ASSERT_FALSE(isHit(found[i].t)) << i;
}

TEST_F(HitTriangle, RaysThatAreNotFiniteHitNothing) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    std::vector<TriangleQuery> queries;
    for (const float bad : {nan, infinity, -infinity})
        for (int i = 0; i < 6; ++i) {
            TriangleQuery q =
                query({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0.1f, 0.2f, 3}, {0.01f, 0.02f, -1});
            (i < 3 ? q.origin : q.direction)[i % 3] = bad;
            queries.push_back(q);
        }
    const std::vector<TriangleAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i)
        EXPECT_FALSE(isHit(found[i].t)) << i;
}

/// NUMERICS 8 and 9: long triangles beside the ray whose t must not be made up.
TEST_F(HitTriangle, SkinnyOnesBesideTheRay) {
    Random random(36);
    std::vector<TriangleQuery> queries;
    for (int i = 0; i < 50000; ++i) {
        const glm::vec3 a = random.inCube(1), along = 100.0f * random.vector();
        const glm::vec3 c = a + along + 1e-3f * random.inCube(1);
        const glm::vec3 origin = a + random.uniform() * along + 0.05f * random.inCube(1);
        const glm::vec3 direction = glm::normalize(along) + 0.01f * random.inCube(1);
        queries.push_back(query(a, a + along, c, origin, direction));
    }
    const std::vector<TriangleAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const TriangleQuery& q = queries[i];
        if (!isHit(found[i].t)) continue;
        const glm::dvec3 d(q.direction), o(q.origin);
        double least = INFINITY, most = -INFINITY; // of t over the triangle
        for (const glm::vec3& v : {q.v0, q.v1, q.v2}) {
            const double t = glm::dot(glm::dvec3(v) - o, d) / glm::dot(d, d);
            least = std::min(least, t), most = std::max(most, t);
        }
        ASSERT_GT(found[i].t, least - 0.02 * 200) << i; // the ray's slope times the length
        ASSERT_LT(found[i].t, most + 0.02 * 200) << i;
    }
}

} // namespace
} // namespace stromboli::test
