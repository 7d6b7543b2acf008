// Traversal of the tree finds what trying every primitive finds.

#include "host/bvh/cpu_traversal.hpp"
#include "tests/bvh/fixtures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace stromboli::test {
namespace {

TraversalHit closestByTryingAll(const Traceable& t, const TraversalRay& ray) {
    const PreparedRay prepared(ray.origin, ray.direction);
    TraversalHit best;
    best.t = ray.tMax;
    for (uint32_t i = 0; i < t.primitives.size(); ++i)
        if (const auto hit = hitPrimitive(t.primitives[i], prepared, ray.tMin, best.t))
            best = {i, hit->t, hit->b1, hit->b2};
    if (!best) best.t = kInfiniteDistance;
    return best;
}

/// Some with one or two components that are zero of either sign, some with an interval that ends
/// inside the scene.
TraversalRay randomRay(Random& random) {
    TraversalRay ray;
    ray.origin = random.inCube(random.below(2) ? 1.0f : 4.0f);
    ray.direction = random.below(2) ? random.direction() : random.inCube(1) - ray.origin;
    const uint32_t kind = random.below(8);
    if (kind < 4) ray.direction[int(kind % 3)] = random.below(2) ? 0.0f : -0.0f;
    if (kind < 2) ray.direction[int(kind + 1)] = random.below(2) ? 0.0f : -0.0f;
    if (random.below(4) == 0) ray.tMin = random.uniform(0, 1);
    if (random.below(4) == 0) ray.tMax = random.uniform(0, 3);
    return ray;
}

/// Returns the number of rays that hit.
uint32_t expectSameAsTryingAll(const Traceable& t, int rays, Random& random) {
    uint32_t hits = 0;
    for (int i = 0; i < rays; ++i) {
        const TraversalRay ray = randomRay(random);
        const TraversalHit expected = closestByTryingAll(t, ray);
        const TraversalHit hit = closestHit(t.layout, t.primitives, ray);
        EXPECT_EQ(hit.t, expected.t) << "ray " << i << " of " << t.primitives.size();
        if (hit.primitive != expected.primitive) { // a tie: the other one is hit at the same t
            EXPECT_TRUE(hit && expected) << "ray " << i;
            if (!hit) continue;
            const auto own =
                hitPrimitive(t.primitives[hit.primitive], PreparedRay(ray.origin, ray.direction),
                             ray.tMin, ray.tMax);
            EXPECT_EQ(own->t, expected.t);
        }
        EXPECT_EQ(anyHit(t.layout, t.primitives, ray), bool(expected)) << "ray " << i;
        hits += bool(hit);
    }
    return hits;
}

TEST(Traversal, SameAsTryingAllPrimitives) {
    Random random(16);
    constexpr int kRaysEach = 1400; // 1e5 rays in total
    uint32_t hits = 0;
    for (const uint32_t maxLeafSize : {1u, 4u, 16u})
        for (const uint32_t n : {1u, 2u, 3u, 4u, 15u, 100u, 500u, 2000u})
            for (const uint32_t spheres : {0u, n / 2, n}) {
                BuildOptions options;
                options.maxLeafSize = maxLeafSize;
                const float size = 2 / std::cbrt(float(n));
                const Traceable t(soup(n - spheres, spheres, 0.5f * size, random), options);
                hits += expectSameAsTryingAll(t, kRaysEach, random);
            }
    EXPECT_GT(hits, 15000u);
}

TEST(Traversal, FlatScene) {
    Random random(17);
    for (int axis = 0; axis < 3; ++axis) {
        Scene scene = soup(300, 0, 0.2f, random);
        for (glm::vec3& p : scene.positions)
            p[axis] = 0.25f;
        const Traceable t(std::move(scene));
        EXPECT_GT(expectSameAsTryingAll(t, 4000, random), 400u);
        for (int i = 0; i < 2000; ++i) { // straight on, and within the plane
            TraversalRay ray;
            ray.origin = random.inCube(1);
            ray.direction = glm::vec3(0.0f);
            ray.direction[axis] = ray.origin[axis] < 0.25f ? 2.0f : -2.0f;
            EXPECT_EQ(closestHit(t.layout, t.primitives, ray).t, closestByTryingAll(t, ray).t);
            ray.direction = random.direction();
            ray.direction[axis] = 0;
            ray.origin[axis] = 0.25f;
            EXPECT_FALSE(closestHit(t.layout, t.primitives, ray));
        }
    }
}

TEST(Traversal, GeometricSeriesAndSliverStrip) {
    Random random(18);
    Scene series;
    for (int i = 0; i < 40; ++i) {
        const float x = std::ldexp(1.0f, -i);
        addTriangle(series, {x, -1, -1}, {x, 1, -1}, {x, 0, 1});
    }
    for (Scene& scene : std::vector<Scene>{series, sliverStrip(2000)}) {
        const Traceable t(std::move(scene));
        EXPECT_GT(expectSameAsTryingAll(t, 2000, random), 50u);
    }
}

TEST(Traversal, IdenticalPrimitivesAreHitOnce) {
    Scene scene;
    for (int i = 0; i < 10000; ++i)
        addTriangle(scene, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    const Traceable t(std::move(scene));
    TraversalRay ray;
    ray.origin = {0, 0, -2};
    const TraversalHit hit = closestHit(t.layout, t.primitives, ray);
    EXPECT_EQ(hit.t, 2);
    EXPECT_EQ(closestHit(t.layout, t.primitives, ray).primitive, hit.primitive);
}

TEST(Traversal, IntervalIsOpenAndAPlanarPrimitiveCanBeSkipped) {
    Scene scene;
    addTriangle(scene, {-1, -1, 1}, {1, -1, 1}, {0, 1, 1});
    addTriangle(scene, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2});
    const Traceable t(std::move(scene));
    TraversalRay ray;
    const TraversalHit first = closestHit(t.layout, t.primitives, ray);
    EXPECT_EQ(first.t, 1);
    ray.tMin = 1;
    EXPECT_EQ(closestHit(t.layout, t.primitives, ray).t, 2);
    ray.tMax = 2;
    EXPECT_FALSE(closestHit(t.layout, t.primitives, ray));
    EXPECT_FALSE(anyHit(t.layout, t.primitives, ray));
    ray.tMin = 0;
    EXPECT_TRUE(anyHit(t.layout, t.primitives, ray));
    ray.skipPrimitive = first.primitive;
    EXPECT_FALSE(anyHit(t.layout, t.primitives, ray));
    ray.tMax = kInfiniteDistance;
    EXPECT_EQ(closestHit(t.layout, t.primitives, ray).t, 2);
}

/// A tree without end: a node that is its own two children.
BinaryLayout endless() {
    BinaryLayout layout;
    const glm::vec3 largest(gpu::LARGEST_COORDINATE);
    layout.nodes = {{-largest, 0, largest, 0, -largest, 0, largest, 0}};
    return layout;
}

TEST(Traversal, ExceedingTheStackThrows) {
    EXPECT_THROW(closestHit(endless(), {}, {}), std::out_of_range);
    EXPECT_THROW(anyHit(endless(), {}, {}), std::out_of_range);
}

TEST(Traversal, RaysThatAreNotFiniteVisitNoNode) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const BinaryLayout layout = endless(); // a visit would exceed the stack
    const auto expectMiss = [&](const TraversalRay& ray) {
        EXPECT_FALSE(closestHit(layout, {}, ray));
        EXPECT_FALSE(anyHit(layout, {}, ray));
    };
    for (const float bad : {kNaN, kInfinity, -kInfinity})
        for (int i = 0; i < 3; ++i) {
            TraversalRay ray;
            ray.origin[i] = bad;
            expectMiss(ray);
            ray = {};
            ray.direction[i] = bad;
            expectMiss(ray);
        }
    for (const auto& [tMin, tMax] : {std::pair{kNaN, 1.0f},
                                     {0.0f, kNaN},
                                     {0.0f, -kInfinity},
                                     {kInfinity, kInfinity},
                                     {2.0f, 1.0f}}) {
        TraversalRay ray;
        ray.tMin = tMin, ray.tMax = tMax;
        expectMiss(ray);
    }
    TraversalRay still;
    still.direction = {0, 0, -0.0f};
    expectMiss(still);
}

TEST(Traversal, ExtremeFiniteRaysEnd) {
    Random random(20);
    const Traceable t(soup(1000, 1000, 0.3f, random));
    for (const float size : {1e-45f, 1e-38f, 1e-20f, 1e20f, 3e38f})
        for (int i = 0; i < 200; ++i) {
            TraversalRay ray;
            ray.origin = random.inCube(1);
            ray.direction = random.direction() * size;
            const TraversalHit hit = closestHit(t.layout, t.primitives, ray);
            EXPECT_FALSE(std::isnan(hit.t));
            ray.origin *= size;
            EXPECT_FALSE(std::isnan(closestHit(t.layout, t.primitives, ray).t));
        }
}

} // namespace
} // namespace stromboli::test
