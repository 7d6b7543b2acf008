#include "host/bvh/cpu_traversal.hpp"
#include "host/bvh/node_record.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/invariants.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

void expectValid(Scene scene) {
    const Traceable t(std::move(scene));
    expectValidLayout(t.layout, t.scene);
}

TEST(Layout, OfNothingHasARootWithoutChildren) {
    const WideLayout layout = buildWideBvh(Scene{});
    expectValidLayout(layout, Scene{});
    const gpu::NodeRecord root = asNode(layout.records.at(0));
    for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
        EXPECT_TRUE(bvh::childBox(root, slot).empty());
    EXPECT_EQ(layout.stackSize, 1u);
    EXPECT_FALSE(closestHit(layout, {}));
    EXPECT_FALSE(anyHit(layout, {}));
}

TEST(Layout, OfFewAndOfManyPrimitives) {
    Random random(44);
    for (const uint32_t n : {1u, 2u, 3u, 8u, 9u, 17u, 300u, 20000u})
        for (const uint32_t spheres : {0u, n / 3, n})
            expectValid(soup(n - spheres, spheres, 0.3f / std::cbrt(float(n)), random));
}

TEST(Layout, OfMeshes) {
    Random random(45);
    for (const uint32_t levels : {0u, 2u, 5u})
        expectValid(starMesh(levels, random));
    expectValid(cubeMesh(9));
    Scene room = landscape(40);
    addRoom(room);
    expectValid(room);
    expectValid(clusterInSoup(random));
    expectValid(sliverStrip(3000));
}

TEST(Layout, OfScenesFarFromTheOrigin) {
    // 1e5 and 1e7 sizes away: origins of grids, and then floats, lie farther apart than cells.
    Random random(46);
    for (const float distance : {1e5f, 1e7f}) {
        Scene scene = starMesh(4, random);
        translate(scene, {distance, -0.7f * distance, 0.3f});
        expectValid(scene);
    }
}

TEST(Layout, OfTinyHugeAndFlatScenes) {
    Random random(47);
    for (const float size : {1e-44f, 1e-38f, 1e-30f, 1e-12f, 1e17f, 1e18f}) {
        Scene scene = soup(500, 100, 0.1f, random);
        scale(scene, size);
        expectValid(scene);
    }
    for (int axis = 0; axis < 3; ++axis)
        for (const float height : {0.0f, 1e-20f, -123.456f}) {
            Scene flat = soup(500, 0, 0.2f, random);
            for (glm::vec3& p : flat.positions)
                p[axis] = height;
            expectValid(flat);
        }
    Scene point;
    for (int i = 0; i < 20; ++i)
        addTriangle(point, {3, 4, 5}, {3, 4, 5}, {3, 4, 5});
    expectValid(point);
}

TEST(Layout, OfManySizesInOneScene) {
    Scene series;
    for (int i = 0; i < 100; ++i) {
        const float x = std::ldexp(1.0f, 20 - i);
        addTriangle(series, {x, -x, -1}, {x, x, -1}, {x, 0, x});
    }
    expectValid(series);
}

TEST(Layout, StackIsAsLargeAsTheDeepestDescentNeeds) {
    // A ray through everything at once fills it: boxes around one point, all hit, from the
    // largest to the smallest.
    Scene nested;
    for (int i = 0; i < 60; ++i) {
        const float r = std::ldexp(1.0f, -i);
        addTriangle(nested, {-r, -r, 0}, {r, -r, 0}, {0, r, 0});
    }
    Random random(48);
    uint32_t fullStacks = 0, deepest = 0;
    for (const Scene& scene :
         {nested, soup(3000, 0, 0.4f, random), starMesh(5, random), clusterInSoup(random)}) {
        const Traceable t(scene);
        uint32_t most = 0;
        for (int i = 0; i < 20000; ++i) {
            TraversalRay ray;
            ray.origin = random.inCube(2);
            ray.direction = random.inCube(0.1f) - ray.origin;
            TraversalCounts counts;
            closestHit(t.layout, ray, &counts); // throws where the stack is too small
            most = std::max(most, counts.mostWaiting);
        }
        EXPECT_LE(most, t.layout.stackSize - 1);
        fullStacks += most == t.layout.stackSize - 1;
        deepest = std::max(deepest, t.layout.stackSize);
    }
    EXPECT_GE(fullStacks, 1u) << "a bound that is never reached is too large";
    EXPECT_GT(deepest, 3u);
}

/// A ray from far away enters the inverted box of an absent child: the reason for which such a slot
/// must never name a node (record_packing.hpp).
TEST(Layout, AbsentChildrenAreEnteredFromFarAwayAndDoNoHarm) {
    Random random(49);
    const Traceable t(soup(400, 0, 0.1f, random));
    uint32_t enteredAbsent = 0, hits = 0;
    for (int i = 0; i < 3000; ++i) {
        TraversalRay ray;
        ray.origin = 1e7f * random.vector();
        ray.direction = random.inCube(0.5f) - ray.origin;
        const PreparedRay prepared(ray.origin, ray.direction);
        for (const Record& record : t.layout.records) {
            if (!isNode(record)) continue;
            const gpu::NodeRecord node = asNode(record);
            const uint32_t entered = enterChildren(node, prepared, kInfiniteDistance);
            for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
                enteredAbsent +=
                    bvh::childBox(node, slot).empty() && (entered >> (slot ^ prepared.octant) & 1u);
        }
        hits += bool(closestHit(t.layout, ray)); // it ends
        anyHit(t.layout, ray);
    }
    EXPECT_GT(enteredAbsent, 1000u);
    EXPECT_GT(hits, 100u);
}

TEST(Layout, AbsentChildIsHitByNoRayFromNearby) {
    // One leaf: rays along and against every axis and diagonal must find it past its siblings.
    Random random(9);
    const Traceable t(soup(0, 1, 0.5f, random));
    const glm::vec3 center = t.scene.spheres[0].center;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const glm::vec3 d(x, y, z);
                if (d == glm::vec3(0.0f)) continue;
                TraversalRay ray;
                ray.origin = center - 3.0f * d;
                ray.direction = d;
                TraversalCounts counts;
                EXPECT_EQ(closestHit(t.layout, ray, &counts).primitive, t.layout.placeOf[0]);
                EXPECT_EQ(counts.nodes + counts.leaves, 2u);
                EXPECT_TRUE(anyHit(t.layout, ray));
                ray.direction = -d;
                EXPECT_FALSE(closestHit(t.layout, ray, &counts));
                EXPECT_EQ(counts.nodes + counts.leaves, 1u);
                EXPECT_FALSE(anyHit(t.layout, ray));
            }
}

} // namespace
} // namespace stromboli::test
