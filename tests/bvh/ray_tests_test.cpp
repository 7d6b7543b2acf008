// The single tests of ray against box, triangle and sphere, against double precision.

#include "host/bvh/cpu_traversal.hpp"
#include "host/bvh/node_record.hpp"
#include "host/core/random.hpp"
#include "tests/bvh/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

bool entersBoxInDouble(const Bounds& box, const glm::dvec3& o, const glm::dvec3& d) {
    double tNear = 0, tFar = INFINITY;
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0) {
            if (o[i] < box.lo[i] || o[i] > box.hi[i]) return false;
            continue;
        }
        const double a = (box.lo[i] - o[i]) / d[i], b = (box.hi[i] - o[i]) / d[i];
        tNear = std::max(tNear, std::min(a, b));
        tFar = std::min(tFar, std::max(a, b));
    }
    return tNear <= tFar;
}

/// The kernel's planes for a node that has the box as its only child, with neither margin nor
/// slack: the grid is laid so that the box's ends are on it.
bool entersWithoutMarginOrSlack(const Bounds& box, const PreparedRay& ray) {
    float tNear = 0, tFar = kInfiniteDistance;
    for (int i = 0; i < 3; ++i) {
        const float cell = (box.hi[i] - box.lo[i]) / 255;
        const float base = (box.lo[i] - ray.origin[i]) * ray.reciprocal[i];
        const float end = 255.0f * (cell * ray.reciprocal[i]) + base;
        tNear = std::max(tNear, std::min(base, end));
        tFar = std::min(tFar, std::max(base, end));
    }
    return tNear <= tFar;
}

/// In slot `slot` of a node, with a larger sibling or none.
gpu::NodeRecord nodeWith(const Bounds& box, uint32_t slot, Random& random) {
    bvh::ChildBoxes boxes;
    boxes[slot] = box;
    if (random.below(2)) {
        const glm::vec3 p = box.lo + random.inCube(0.3f);
        boxes[(slot + 3) % 8] = Bounds{glm::min(p, box.lo), glm::max(p, box.hi)};
    }
    return bvh::packNode(boxes, 0, bvh::boxPadding(box));
}

/// Boxes of which some are flat, near the origin and far from it, and rays at points of them, at
/// their corners and edges above all, from near and from 1e7 away; some with components that are
/// zero of either sign, in the planes of the box.
TEST(EnterChildren, LosesNoBoxThatTheExactRayMeets) {
    Random random(12);
    uint32_t met = 0, lostWithout = 0, inPlanes = 0;
    for (int i = 0; i < 400000; ++i) {
        Bounds box;
        box.lo = random.inCube(1) * (random.below(3) ? 1.0f : 1e5f);
        box.hi = box.lo;
        glm::vec3 target;
        for (int axis = 0; axis < 3; ++axis) {
            if (random.below(3) > 0) box.hi[axis] += random.uniform() * 0.1f;
            const uint32_t where = random.below(3);
            target[axis] = where == 0   ? box.lo[axis]
                           : where == 1 ? box.hi[axis]
                                        : 0.5f * (box.lo[axis] + box.hi[axis]);
        }
        glm::vec3 origin = target + random.vector() * (random.below(2) ? 3.0f : 1e7f);
        for (int axis = 0; axis < 3; ++axis)
            if (random.below(4) == 0) origin[axis] = target[axis];
        const glm::vec3 direction = target - origin;
        if (direction == glm::vec3(0.0f) || !entersBoxInDouble(box, origin, direction)) continue;
        ++met;
        inPlanes += direction.x == 0 || direction.y == 0 || direction.z == 0;
        const PreparedRay ray(origin, direction);
        const uint32_t slot = random.below(8);
        const uint32_t entered = enterChildren(nodeWith(box, slot, random), ray, kInfiniteDistance);
        ASSERT_TRUE(entered >> (slot ^ ray.octant) & 1u) << "ray " << i;
        lostWithout += !entersWithoutMarginOrSlack(box, ray);
    }
    EXPECT_GT(met, 50000u);
    EXPECT_GT(inPlanes, 20000u);
    EXPECT_GT(lostWithout, 1000u) << "these rays need neither margin nor slack: a blunt test";
}

TEST(EnterChildren, ReciprocalOfAZeroIsFiniteAndKeepsTheSign) {
    for (const float length : {1e-15f, 1.0f, 1e15f}) {
        const PreparedRay ray({0, 0, 0}, length * glm::vec3(0, 1, -1e-30f));
        EXPECT_FLOAT_EQ(ray.reciprocal.x, 0x1p60f / length);
        EXPECT_FLOAT_EQ(ray.reciprocal.y, 1 / length);
        EXPECT_FLOAT_EQ(ray.reciprocal.z, -0x1p60f / length);
        EXPECT_EQ(ray.octant, 3u);
    }
}

TEST(EnterChildren, RespectsTheInterval) {
    bvh::ChildBoxes boxes;
    boxes[5] = Bounds{{-1, -1, 2}, {1, 1, 3}};
    const gpu::NodeRecord node = bvh::packNode(boxes, 0, 0);
    const auto enters = [&](const glm::vec3& origin, const glm::vec3& direction, float tMax) {
        const PreparedRay ray(origin, direction);
        const uint32_t entered = enterChildren(node, ray, tMax);
        EXPECT_EQ(entered & ~(1u << (5 ^ ray.octant)), 0u) << "an absent child";
        return entered != 0;
    };
    // Cells are 1/64 here, and boxes may be larger by one on each side, and a margin.
    const float cell = 1.01f / 64;
    for (const float sign : {1.0f, -1.0f}) {
        const float start = sign > 0 ? 0.0f : 5.0f;
        EXPECT_TRUE(enters({0, 0, start}, {0, 0, sign}, 10));
        EXPECT_TRUE(enters({0, 0, start}, {0, 0, sign}, 2));
        EXPECT_FALSE(enters({0, 0, start}, {0, 0, sign}, 2 - 2 * cell));
    }
    EXPECT_TRUE(enters({0, 0, 2.5f}, {0, 0, 1}, 10));
    EXPECT_TRUE(enters({0, 0, 3}, {0, 0, 1}, 10)) << "leaves it at t = 0";
    EXPECT_FALSE(enters({0, 0, 3 + 2 * cell}, {0, 0, 1}, 10)) << "behind";
    EXPECT_FALSE(enters({1 + 2 * cell, 0, 0}, {0, 0, 1}, 10)) << "beside";
    EXPECT_FALSE(enters({-1 - 2 * cell, 0, 0}, {0, 0, 1}, 10)) << "beside";
}

TEST(EnterChildren, BitsAreInTheRaysOrder) {
    bvh::ChildBoxes boxes;
    for (uint32_t slot = 0; slot < 8; ++slot)
        boxes[slot] = Bounds{glm::vec3(0), glm::vec3(1)};
    boxes[6].reset();
    const gpu::NodeRecord node = bvh::packNode(boxes, 0, 0);
    for (uint32_t octant = 0; octant < 8; ++octant) {
        const glm::vec3 d(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
        const PreparedRay ray(glm::vec3(0.5f) - d, d);
        EXPECT_EQ(ray.octant, octant);
        EXPECT_EQ(enterChildren(node, ray, 10), 255u ^ 1u << (6 ^ octant));
    }
}

TEST(HitTriangle, AgreesWithDoublePrecision) {
    // A corner is off by at most 6 roundings of coordinates up to 4 (2^-20 or so in the sheared
    // plane): a ray passing the edges farther than that must be decided right.
    constexpr double kMargin = 4e-6;
    Random random(14);
    uint32_t hits = 0, misses = 0;
    for (int i = 0; i < 200000; ++i) {
        const glm::vec3 a = random.inCube(1), b = random.inCube(1), c = random.inCube(1);
        const glm::vec3 origin = random.inCube(2), direction = random.vector();
        const TriangleTruth truth = intersectInDouble(a, b, c, origin, direction);
        const auto hit = hitTriangle(a, b, c, PreparedRay(origin, direction));
        if (std::abs(truth.margin) < kMargin) continue;
        ASSERT_EQ(hit.has_value(), truth.margin > 0) << i;
        if (!hit) {
            ++misses;
            continue;
        }
        ++hits;
        if (truth.margin < 0.01) continue; // edge-on ones are ill-conditioned
        EXPECT_NEAR(hit->t, truth.t, 3e-4);
        EXPECT_NEAR(hit->b1, truth.weights[1], 3e-4);
        EXPECT_NEAR(hit->b2, truth.weights[2], 3e-4);
    }
    EXPECT_GT(hits, 4000u);
    EXPECT_GT(misses, 5000u);
}

TEST(HitTriangle, OfAnySize) {
    for (const float size : {1e-12f, 1e-6f, 2e-4f, 1.0f, 1e6f, 1e9f}) {
        const glm::vec3 a(0, 0, 0), b(size, 0, 0), c(0, size, 0);
        const glm::vec3 center = (a + b + c) / 3.0f;
        const auto hit =
            hitTriangle(a, b, c, PreparedRay(center + glm::vec3(0, 0, size), {0, 0, -1}));
        ASSERT_TRUE(hit) << size;
        EXPECT_NEAR(hit->t, size, 4 * 0x1p-23 * size);
        EXPECT_NEAR(hit->b1, 1.0 / 3, 1e-6);
        EXPECT_NEAR(hit->b2, 1.0 / 3, 1e-6);
    }
}

TEST(HitTriangle, WithoutAreaOrEdgeOnIsMissed) {
    const glm::vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
    EXPECT_FALSE(hitTriangle(a, b, c, PreparedRay({-1, 0.25f, 0}, {1, 0, 0})));
    EXPECT_FALSE(hitTriangle(a, a, a, PreparedRay({0, 0, 1}, {0, 0, -1})));
    EXPECT_FALSE(hitTriangle(a, b, b, PreparedRay({0.5f, 0, 1}, {0, 0, -1})));
    EXPECT_FALSE(hitTriangle(a, b, 0.5f * b, PreparedRay({0.25f, 0, 1}, {0, 0, -1})));
}

/// A sphere's near and far hit in double, or {1, 0} for none.
std::pair<double, double> sphereInDouble(const glm::dvec3& center, double radius,
                                         const glm::dvec3& o, const glm::dvec3& d) {
    const double a = glm::dot(d, d), b = glm::dot(center - o, d) / a;
    const glm::dvec3 l = o + b * d - center;
    const double discriminant = (radius * radius - glm::dot(l, l)) / a;
    if (discriminant < 0) return {1, 0};
    return {b - std::sqrt(discriminant), b + std::sqrt(discriminant)};
}

TEST(HitSphere, AgreesWithDoublePrecisionFarAway) {
    Random random(15);
    for (const float distance : {0.05f, 1.0f, 100.0f, 1e4f, 1e6f}) {
        uint32_t hits = 0;
        for (int i = 0; i < 20000; ++i) {
            const glm::vec3 center = random.inCube(0.1f);
            const float radius = random.uniform(0.05f, 0.2f);
            glm::vec3 origin = random.inCube(0.1f);
            origin[int(random.below(3))] += random.below(2) ? distance : -distance;
            const glm::vec3 direction = center + random.inCube(0.2f) - origin;
            const auto [near, far] = sphereInDouble(center, radius, origin, direction);
            const auto hit =
                hitSphere(center, radius, PreparedRay(origin, direction), 0, kInfiniteDistance);
            // Across the line, coordinates stay below 1 and so do their 16 or so roundings of
            // 2^-24 each; along it, t is known to some roundings of the distance, and where the
            // line is nearly a tangent, to the root of the error across.
            constexpr double kAcross = 16 * 0x1p-24;
            const double along = 8 * 0x1p-24 * (1.0 + distance);
            const double length = glm::length(glm::dvec3(direction));
            const glm::dvec3 toCenter = glm::dvec3(center) - glm::dvec3(origin);
            const double across = glm::length(glm::cross(toCenter, glm::dvec3(direction))) / length;
            const double nearestEnd = std::min(std::abs(near), std::abs(far)) * length;
            if (std::abs(across - radius) < kAcross || nearestEnd < along) continue;
            const double truth = near > 0 ? near : far;
            ASSERT_EQ(hit.has_value(), near <= far && truth > 0) << distance << ' ' << i;
            if (!hit) continue;
            ++hits;
            EXPECT_NEAR(hit->t * length, truth * length, std::sqrt(2 * radius * kAcross) + along);
        }
        EXPECT_GT(hits, 2000u) << distance;
    }
}

TEST(HitSphere, RespectsTheInterval) {
    const PreparedRay ray({0, 0, -3}, {0, 0, 1});
    EXPECT_EQ(hitSphere({0, 0, 0}, 1, ray, 0, 10)->t, 2);
    EXPECT_EQ(hitSphere({0, 0, 0}, 1, ray, 2, 10)->t, 4) << "the interval is open";
    EXPECT_FALSE(hitSphere({0, 0, 0}, 1, ray, 2, 4));
    EXPECT_FALSE(hitSphere({0, 0, 0}, 1, ray, 0, 2));
    EXPECT_FALSE(hitSphere({0, 0, 0}, 1, ray, 4, 10));
    EXPECT_EQ(hitSphere({0, 0, 0}, 1, PreparedRay({0, 0, 0}, {0, 0, 2}), 0, 10)->t, 0.5f);
    EXPECT_EQ(hitSphere({0, 0, 0}, 1, PreparedRay({0, 0, -1}, {0, 0, 1}), 0, 10)->t, 2)
        << "from its surface";
}

} // namespace
} // namespace stromboli::test
