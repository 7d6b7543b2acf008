// Trees of scenes in which an animation moves things: what stands still has a tree of its own,
// which is built once.
#include "host/bvh/leaf_items.hpp"
#include "host/bvh/two_level_layout.hpp"
#include "tests/bvh/fixtures.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stromboli {
namespace {

using namespace test;

/// A landscape, and above it a cube that moves: instances 0 and 1, in turns as a file may have
/// them.
Scene moment(float place) {
    Scene still = landscape(20);
    Scene scene = still;
    scene.triangles.resize(still.triangles.size() / 2);
    Scene cube = cubeMesh(2);
    const auto first = uint32_t(scene.positions.size());
    for (const glm::vec3& p : cube.positions)
        scene.positions.push_back(0.2f * p + glm::vec3(place, 0.5f, -place));
    for (Triangle t : cube.triangles) {
        for (uint32_t& corner : t.corner)
            corner += first;
        t.instance = 1;
        scene.triangles.push_back(t);
    }
    scene.triangles.insert(scene.triangles.end(),
                           still.triangles.begin() + std::ptrdiff_t(still.triangles.size() / 2),
                           still.triangles.end());
    scene.spheres.push_back({{0, 2, 0}, 0.3f, 0, 0});
    scene.instances = {"land", "cube"};
    scene.movingInstances = {false, true};
    return scene;
}

TraversalRay someRay(Random& random) {
    const glm::vec3 from = random.inCube(3.0f);
    return {.origin = from, .direction = random.inCube(1.0f) - 0.5f * from};
}

/// Rays hit what they hit in a tree over everything: the distances are those of triangles in the
/// world, whatever the tree.
void expectSameHits(const Scene& scene, const WideLayout& layout) {
    Scene plain = scene;
    plain.movingInstances.clear();
    const WideLayout other = buildWideBvh(plain);
    Random random(3);
    uint32_t hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const TraversalRay ray = someRay(random);
        TraversalCounts counts;
        const TraversalHit a = closestHit(layout, ray, &counts), b = closestHit(other, ray);
        ASSERT_EQ(bool(a), bool(b)) << i;
        ASSERT_EQ(a.t, b.t) << i;
        ASSERT_LE(counts.mostWaiting, layout.stackSize);
        hits += bool(a);
    }
    EXPECT_GT(hits, 2000u);
}

TEST(Moments, HaveAllPrimitives) {
    const Scene scene = moment(0.1f);
    const WideLayout layout = buildWideBvh(scene);
    const size_t primitives = scene.triangles.size() + scene.spheres.size();
    ASSERT_EQ(layout.primitiveOrder.size(), primitives);
    ASSERT_EQ(layout.placeOf.size(), primitives);
    std::vector<uint32_t> order = layout.primitiveOrder;
    std::ranges::sort(order);
    for (uint32_t i = 0; i < primitives; ++i)
        ASSERT_EQ(order[i], i);
    for (uint32_t i = 0; i < primitives; ++i) {
        const gpu::LeafRecord leaf = asLeaf(layout.records.at(layout.placeOf[i] / 2));
        ASSERT_EQ(layout.primitiveOrder.at((leaf.primitive & gpu::RECORD_INDEX_MASK) +
                                           layout.placeOf[i] % 2),
                  i);
    }
    EXPECT_TRUE(layout.recordOfPlacement.empty());
    EXPECT_TRUE(isNode(layout.records[0]));
}

TEST(Moments, AreHitAsOneTreeIs) {
    const Scene scene = moment(0.1f);
    expectSameHits(scene, buildWideBvh(scene));
}

TEST(Moments, WhatStandsStillIsBuiltOnce) {
    KeptTrees kept;
    for (const float place : {0.0f, 0.1f, 0.3f, -0.4f}) {
        const Scene scene = moment(place);
        const WideLayout layout = buildWideBvh(scene, {}, &kept), alone = buildWideBvh(scene);
        EXPECT_EQ(layout.records, alone.records) << "the same bytes as by itself";
        EXPECT_EQ(layout.primitiveOrder, alone.primitiveOrder);
        EXPECT_EQ(layout.placeOf, alone.placeOf);
        EXPECT_EQ(layout.stackSize, alone.stackSize);
    }
    EXPECT_EQ(kept.built(), 1u);
}

TEST(Moments, WhatChangesIsBuiltAgain) {
    KeptTrees kept;
    Scene scene = moment(0);
    buildWideBvh(scene, {}, &kept);
    scene.positions[7].y += 0.01f; // of the land
    const WideLayout layout = buildWideBvh(scene, {}, &kept);
    EXPECT_EQ(kept.built(), 2u);
    EXPECT_EQ(layout.records, buildWideBvh(scene).records);
    scene.triangles.erase(scene.triangles.begin() + 5);
    EXPECT_EQ(buildWideBvh(scene, {}, &kept).records, buildWideBvh(scene).records);
    EXPECT_EQ(kept.built(), 3u);
}

/// Boxes are padded by a part of the largest coordinate that there is (docs/theory/numerics.md):
/// the land needs more once the cube is far away.
TEST(Moments, PaddingIsThatOfTheWholeWorld) {
    KeptTrees kept;
    buildWideBvh(moment(0), {}, &kept);
    const Scene far = moment(1e4f);
    const WideLayout layout = buildWideBvh(far, {}, &kept);
    EXPECT_EQ(kept.built(), 2u);
    EXPECT_EQ(layout.records, buildWideBvh(far).records);
    EXPECT_NE(layout.records, buildWideBvh(moment(0)).records);
}

TEST(Moments, MayMoveAllOrNothing) {
    Scene scene = moment(0.2f);
    scene.movingInstances = {true, true};
    expectSameHits(scene, buildWideBvh(scene));
    Scene plain = scene;
    plain.movingInstances = {false, false};
    EXPECT_EQ(buildWideBvh(scene).records, buildWideBvh(plain).records);
}

/// A moving placement, beside triangles that stand still.
TEST(Moments, PrototypesAreBuiltOnce) {
    Scene scene = cubeMesh(2);
    scene.prototypes = {{0, uint32_t(scene.triangles.size())}};
    const Scene land = landscape(8);
    const auto first = uint32_t(scene.positions.size());
    scene.positions.insert(scene.positions.end(), land.positions.begin(), land.positions.end());
    for (Triangle t : land.triangles) {
        for (uint32_t& corner : t.corner)
            corner += first;
        t.instance = 1;
        scene.triangles.push_back(t);
    }
    scene.placements.push_back({.prototype = 0, .instance = 0});
    scene.movingInstances = {true, false};
    KeptTrees kept;
    for (const float y : {1.5f, 2.0f, 2.5f}) {
        scene.placements[0].toWorld[1].w = y;
        const WideLayout layout = buildWideBvh(scene, {}, &kept);
        ASSERT_EQ(layout.recordOfPlacement.size(), 1u);
        const TraversalHit hit =
            closestHit(layout, {.origin = {0, 5, 0}, .direction = {0.01f, -1, 0.02f}});
        EXPECT_TRUE(isPlacement(layout.records.at(layout.recordOfPlacement[0])));
        EXPECT_EQ(hit.placement, layout.recordOfPlacement[0]);
        EXPECT_NEAR(hit.t, 4 - y, 1e-5);
        const TraversalHit beside =
            closestHit(layout, {.origin = {0.9f, 9, 0.9f}, .direction = {0, -1, 0}});
        EXPECT_TRUE(beside);
        expectSameHits(scene, layout);
    }
    EXPECT_EQ(kept.built(), 2u);
}

} // namespace
} // namespace stromboli
