// Traversal of the tree finds what trying every primitive finds.

#include "host/bvh/cpu_traversal.hpp"
#include "host/bvh/node_record.hpp"
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
    for (uint32_t i = 0; i < t.layout.placeOf.size(); ++i)
        if (const auto hit = t.hitPrimitive(i, prepared, ray.tMin, best.t))
            best = {t.layout.placeOf[i], hit->t, hit->b1, hit->b2};
    if (!best) best.t = kInfiniteDistance;
    return best;
}

/// Some with one or two components that are zero of either sign, some with an interval that ends
/// inside the scene.
TraversalRay randomRay(Random& random) {
    TraversalRay ray;
    ray.origin = random.inCube(random.below(2) ? 1.0f : 4.0f);
    ray.direction = random.below(2) ? random.vector() : random.inCube(1) - ray.origin;
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
        const TraversalHit hit = closestHit(t.layout, ray);
        EXPECT_EQ(hit.t, expected.t) << "ray " << i << " of " << t.layout.placeOf.size();
        if (hit.primitive != expected.primitive) { // a tie: the other one is hit at the same t
            EXPECT_TRUE(hit && expected) << "ray " << i;
            if (!hit) continue;
            const auto own =
                t.hitPrimitive(t.primitiveAt.at(hit.primitive),
                               PreparedRay(ray.origin, ray.direction), ray.tMin, ray.tMax);
            EXPECT_EQ(own->t, expected.t);
        }
        EXPECT_EQ(anyHit(t.layout, ray), bool(expected)) << "ray " << i;
        hits += bool(hit);
    }
    return hits;
}

TEST(Traversal, SameAsTryingAllPrimitives) {
    Random random(16);
    constexpr int kRaysEach = 3000; // 1e5 rays in total
    uint32_t hits = 0;
    for (const uint32_t n : {0u, 1u, 2u, 3u, 4u, 8u, 9u, 15u, 100u, 500u, 2000u})
        for (const uint32_t spheres : {0u, n / 2, n}) {
            const float size = 2 / std::cbrt(float(n + 1));
            const Traceable t(soup(n - spheres, spheres, 0.5f * size, random));
            hits += expectSameAsTryingAll(t, kRaysEach, random);
        }
    EXPECT_GT(hits, 12000u);
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
            EXPECT_EQ(closestHit(t.layout, ray).t, closestByTryingAll(t, ray).t);
            ray.direction = random.vector();
            ray.direction[axis] = 0;
            ray.origin[axis] = 0.25f;
            EXPECT_FALSE(closestHit(t.layout, ray));
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
    const TraversalHit hit = closestHit(t.layout, ray);
    EXPECT_EQ(hit.t, 2);
    EXPECT_EQ(closestHit(t.layout, ray).primitive, hit.primitive);
}

TEST(Traversal, IntervalIsOpenAndAPlanarPrimitiveCanBeSkipped) {
    Scene scene;
    addTriangle(scene, {-1, -1, 1}, {1, -1, 1}, {0, 1, 1});
    addTriangle(scene, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2});
    const Traceable t(std::move(scene));
    TraversalRay ray;
    const TraversalHit first = closestHit(t.layout, ray);
    EXPECT_EQ(first.t, 1);
    ray.tMin = 1;
    EXPECT_EQ(closestHit(t.layout, ray).t, 2);
    ray.tMax = 2;
    EXPECT_FALSE(closestHit(t.layout, ray));
    EXPECT_FALSE(anyHit(t.layout, ray));
    ray.tMin = 0;
    EXPECT_TRUE(anyHit(t.layout, ray));
    ray.skipPrimitive = first.primitive;
    EXPECT_FALSE(anyHit(t.layout, ray));
    ray.tMax = kInfiniteDistance;
    EXPECT_EQ(closestHit(t.layout, ray).t, 2);
}

TEST(Traversal, ScenesOfAnySizeAndFarAway) {
    // Sizes at which the triangle test itself works: products of three lengths within float.
    Random random(19);
    for (const float size : {1e-12f, 1e-6f, 1e6f, 1e12f}) {
        Scene scene = soup(500, 200, 0.2f, random);
        scale(scene, size);
        const Traceable t(std::move(scene));
        uint32_t hits = 0;
        for (int i = 0; i < 2000; ++i) {
            TraversalRay ray = randomRay(random);
            ray.origin *= size, ray.tMin *= size, ray.tMax *= size;
            const TraversalHit expected = closestByTryingAll(t, ray);
            EXPECT_EQ(closestHit(t.layout, ray).t, expected.t) << size << ' ' << i;
            hits += bool(expected);
        }
        EXPECT_GT(hits, 300u);
    }
    Scene moved = soup(2000, 0, 0.2f, random);
    translate(moved, {1e5f, -3e5f, 7.0f});
    const Traceable t(std::move(moved));
    uint32_t hits = 0;
    for (int i = 0; i < 4000; ++i) {
        TraversalRay ray = randomRay(random);
        ray.origin += glm::vec3(1e5f, -3e5f, 7.0f);
        EXPECT_EQ(closestHit(t.layout, ray).t, closestByTryingAll(t, ray).t) << i;
        hits += bool(closestHit(t.layout, ray));
    }
    EXPECT_GT(hits, 300u);
}

TEST(Traversal, TinyAndHugeScenesEnd) {
    Random random(20);
    for (const float size : {1e-44f, 1e-38f, 1e-30f, 1e17f, 5e17f}) {
        Scene scene = soup(500, 200, 0.2f, random);
        scale(scene, size);
        const Traceable t(std::move(scene));
        for (int i = 0; i < 500; ++i) {
            TraversalRay ray = randomRay(random);
            ray.origin *= size;
            TraversalCounts counts;
            closestHit(t.layout, ray, &counts);
            EXPECT_LE(counts.nodes + counts.leaves, 2 * t.layout.records.size());
            ray.direction *= size;
            EXPECT_FALSE(std::isnan(closestHit(t.layout, ray).t));
        }
    }
}

TEST(Traversal, PairsAreTwoTriangles) {
    // Each can be hit and skipped on its own; the numbers of both are those of the scene.
    const Traceable t(cubeMesh(1));
    Random random(21);
    for (int i = 0; i < 2000; ++i) {
        TraversalRay ray;
        ray.direction = random.vector();
        const TraversalHit hit = closestHit(t.layout, ray);
        ASSERT_TRUE(hit);
        const PreparedRay prepared(ray.origin, ray.direction);
        const auto alone =
            t.hitPrimitive(t.primitiveAt.at(hit.primitive), prepared, 0, kInfiniteDistance);
        ASSERT_TRUE(alone);
        EXPECT_EQ(alone->t, hit.t);
        EXPECT_EQ(alone->b1, hit.b1);
        EXPECT_EQ(alone->b2, hit.b2);
        ray.skipPrimitive = hit.primitive;
        const TraversalHit other = closestHit(t.layout, ray);
        EXPECT_TRUE(!other || other.t == hit.t) << "only a ray through an edge hits another";
    }
}

/// A tree without end: a node whose eight children are itself and its likes.
WideLayout endless() {
    bvh::ChildBoxes boxes;
    boxes.fill(Bounds{glm::vec3(-1), glm::vec3(1)});
    WideLayout layout;
    layout.records.assign(8, std::bit_cast<Record>(bvh::packNode(boxes, 0, 0)));
    return layout;
}

TEST(Traversal, ExceedingTheStackThrows) {
    EXPECT_THROW(closestHit(endless(), {}), std::out_of_range);
    EXPECT_THROW(anyHit(endless(), {}), std::out_of_range);
}

TEST(Traversal, RaysThatAreNotFiniteVisitNoNode) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const WideLayout layout = endless(); // a visit would exceed the stack
    const auto expectMiss = [&](const TraversalRay& ray) {
        EXPECT_FALSE(closestHit(layout, ray));
        EXPECT_FALSE(anyHit(layout, ray));
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
    Random random(25);
    const Traceable t(soup(1000, 1000, 0.3f, random));
    for (const float size : {1e-45f, 1e-38f, 1e-20f, 1e20f, 3e38f})
        for (int i = 0; i < 200; ++i) {
            TraversalRay ray;
            ray.origin = random.inCube(1);
            ray.direction = random.vector() * size;
            const TraversalHit hit = closestHit(t.layout, ray);
            EXPECT_FALSE(std::isnan(hit.t));
            ray.origin *= size;
            EXPECT_FALSE(std::isnan(closestHit(t.layout, ray).t));
        }
}

} // namespace
} // namespace stromboli::test
