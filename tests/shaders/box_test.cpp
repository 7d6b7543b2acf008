// enterBox of intersect.glsl: never loses a box, and finds few that are missed.
#include "shaders/shared/scene_types.h"
#include "tests/bvh/random.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/enter_box_shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli::test {
namespace {

using gpu::BoxAnswer;
using gpu::BoxQuery;

constexpr float kInfinite = 3.402823466e38f;

BoxQuery query(const glm::vec3& low, const glm::vec3& high, const glm::vec3& origin,
               const glm::vec3& direction, float tMax = kInfinite) {
    return {low, tMax, high, 0, origin, 0, direction, 0};
}

/// Where the line is within the box; near > far: nowhere. No component of the direction is 0.
struct Interval {
    double near, far;
};

Interval truth(const BoxQuery& q) {
    Interval at{0, q.tMax};
    for (int i = 0; i < 3; ++i) {
        const double a = (double(q.low[i]) - q.origin[i]) / q.direction[i];
        const double b = (double(q.high[i]) - q.origin[i]) / q.direction[i];
        at.near = std::max(at.near, std::min(a, b));
        at.far = std::min(at.far, std::max(a, b));
    }
    return at;
}

class EnterBox : public DeviceTest {
  protected:
    std::vector<BoxAnswer> answers(const std::vector<BoxQuery>& queries) {
        return ask<BoxAnswer>(enter_box_shader, queries);
    }
};

/// Rays at points of boxes, most of them flat, at their corners and edges above all, from near
/// and from 1e7 away.
TEST_F(EnterBox, LosesNoBoxThatTheExactRayMeets) {
    Random random(51);
    std::vector<BoxQuery> queries;
    for (int i = 0; i < 500000; ++i) {
        const glm::vec3 low = random.inCube(1);
        glm::vec3 high = low, target;
        for (int axis = 0; axis < 3; ++axis) {
            if (random.below(3) > 0) high[axis] += random.uniform() * 0.1f;
            const uint32_t where = random.below(3);
            target[axis] = where == 0   ? low[axis]
                           : where == 1 ? high[axis]
                                        : 0.5f * (low[axis] + high[axis]);
        }
        if (i % 4 == 0) target += 1e-3f * random.inCube(1);
        const glm::vec3 origin = random.direction() * (random.below(2) ? 3.0f : 1e7f);
        queries.push_back(query(low, high, origin, target - origin));
    }
    const std::vector<BoxAnswer> found = answers(queries);
    int met = 0, lostNaively = 0, foundWrongly = 0, passed = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const Interval at = truth(queries[i]);
        const bool enters = found[i].t < kInfinite;
        if (at.near <= at.far) {
            ++met;
            ASSERT_TRUE(enters) << i;
            ASSERT_NEAR(found[i].t, at.near, 12 * 0x1p-24 * at.near) << i;
            lostNaively += !(found[i].naive < kInfinite);
        } else if (at.near > at.far * (1 + 100 * 0x1p-24)) { // BOX_SLACK is 64 of these
            ++passed;
            foundWrongly += enters;
        }
    }
    EXPECT_GT(met, 20000);
    EXPECT_GT(passed, 10000);
    EXPECT_EQ(foundWrongly, 0) << "the slack is wider than it need be";
    EXPECT_GT(lostNaively, 20) << "negative control: without slack boxes are lost";
}

TEST_F(EnterBox, InvertedBoxIsNotHit) {
    const glm::vec3 largest(gpu::LARGEST_COORDINATE);
    Random random(52);
    std::vector<BoxQuery> queries;
    for (int i = 0; i < 2000; ++i) {
        glm::vec3 d = random.direction();
        if (i % 3 == 0) d[int(random.below(3))] = i % 2 ? 0.0f : -0.0f;
        queries.push_back(query(largest, -largest, random.inCube(10), d));
    }
    for (const BoxAnswer& a : answers(queries))
        ASSERT_EQ(a.t, kInfinite);
}

TEST_F(EnterBox, RespectsTheInterval) {
    const glm::vec3 low(-1, -1, 2), high(1, 1, 3), o(0, 0, 0), z(0, 0, 1);
    const std::vector<BoxAnswer> found =
        answers({query(low, high, o, z, 10), query(low, high, o, z, 2),
                 query(low, high, o, z, 1.99f), query(low, high, {0, 0, 2.5f}, z, 10),
                 query(low, high, {0, 0, 3}, z, 10), query(low, high, {0, 0, 3.1f}, z, 10),
                 query(low, high, {1.1f, 0, 0}, z, 10), query(low, high, {-1.1f, 0, 0}, z, 10)});
    const float expected[] = {2, 2, kInfinite, 0, 0, kInfinite, kInfinite, kInfinite};
    for (size_t i = 0; i < found.size(); ++i)
        EXPECT_EQ(found[i].t, expected[i]) << i;
}

/// A ray in the common plane of two boxes, with a zero of either sign across it, enters at least
/// one of them: what lies in the plane belongs to both.
TEST_F(EnterBox, RayInThePlaneBetweenTwoBoxes) {
    std::vector<BoxQuery> queries;
    for (int axis = 0; axis < 3; ++axis)
        for (const float zero : {0.0f, -0.0f})
            for (const float plane : {0.0f, 1.0f, -0.7f, 1e-9f, 3e5f}) {
                glm::vec3 low(-1, -1, -1), middleHigh(1, 1, 1), middleLow = low, high(1, 1, 1);
                low[axis] = plane - 1, middleHigh[axis] = plane;
                middleLow[axis] = plane, high[axis] = plane + 1;
                glm::vec3 origin(0.5f), direction(zero);
                origin[axis] = plane;
                direction[(axis + 1) % 3] = 1;
                origin[(axis + 1) % 3] = -4;
                queries.push_back(query(low, middleHigh, origin, direction));
                queries.push_back(query(middleLow, high, origin, direction));
            }
    const std::vector<BoxAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); i += 2)
        EXPECT_EQ(std::min(found[i].t, found[i + 1].t), 3) << i;
}

TEST_F(EnterBox, RayThatIsNotFiniteIsHandledInFiniteArithmetic) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<BoxAnswer> found =
        answers({query({-1, -1, 2}, {1, 1, 3}, {nan, nan, nan}, {nan, nan, nan}, nan)});
    EXPECT_FALSE(std::isnan(found[0].t)); // in or out, but a comparison that can be trusted
}

} // namespace
} // namespace stromboli::test
