// Boxes of triangles are split where that saves visits, and rays find what they found without.

#include "host/bvh/split_items.hpp"

#include "host/bvh/statistics.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/invariants.hpp"

#include <glm/gtx/component_wise.hpp>
#include <gtest/gtest.h>

#include <map>

namespace stromboli::test {
namespace {

using bvh::ItemBoxes;

ItemBoxes split(const Scene& scene, const SplitOptions& options = {}) {
    const std::vector<bvh::LeafItem> items = bvh::makeLeafItems(scene);
    return bvh::splitItems(scene, items, bvh::itemBounds(scene, items), options);
}

/// Beams: long thin triangles askew to the axes, in pairs with a common edge.
Scene beams(uint32_t n, Random& random) {
    Scene scene;
    for (uint32_t i = 0; i < n; ++i) {
        const glm::vec3 a = random.inCube(1), along = 1.5f * random.vector();
        const glm::vec3 across = 0.01f * random.vector();
        const auto first = uint32_t(scene.positions.size());
        for (const glm::vec3& p : {a, a + along, a + along + across, a + across})
            scene.positions.push_back(p);
        scene.triangles.push_back({{first, first + 1, first + 2}});
        scene.triangles.push_back({{first, first + 2, first + 3}});
    }
    return scene;
}

BuildOptions unsplit() {
    BuildOptions options;
    options.split.most = 0;
    return options;
}

TEST(SplitItems, ADiagonalTriangleIsSplitAndAnAlignedOneIsNot) {
    Scene scene;
    addTriangle(scene, {-1, -1, -1}, {1, 1, 1}, {1, 1.01f, 1});
    const auto first = uint32_t(scene.positions.size()); // a square in a plane of the axes
    for (const glm::vec3& p : {glm::vec3(-1, -1, 0), {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}})
        scene.positions.push_back(p);
    scene.triangles.push_back({{first, first + 1, first + 2}});
    scene.triangles.push_back({{first, first + 2, first + 3}});
    const ItemBoxes boxes = split(scene, {8, 0, 0});
    const uint32_t square = bvh::makeLeafItems(scene)[0].count() == 2 ? 0 : 1;
    double area = 0;
    std::map<uint32_t, int> parts;
    for (size_t i = 0; i < boxes.boxes.size(); ++i) {
        ++parts[boxes.itemOf[i]];
        if (boxes.itemOf[i] != square) area += boxes.boxes[i].halfArea();
    }
    EXPECT_EQ(boxes.itemOf[0], 0u);
    EXPECT_EQ(boxes.itemOf[1], 1u);
    EXPECT_EQ(parts[square], 1) << "its box has no volume, and two boxes have the same area";
    EXPECT_EQ(parts[1 - square], 17) << "all that may be had";
    // If there were 16 equal parts, each would have 1/256 of the area; 17 are a little uneven.
    EXPECT_LT(area, 12.0 / 16 * 1.3);
}

TEST(SplitItems, SpheresAndPlacementsAreNotSplit) {
    Scene scene;
    scene.spheres.push_back({{0, 0, 0}, 1, 0, 0});
    scene.spheres.push_back({{5, 5, 5}, 1, 0, 0});
    EXPECT_EQ(split(scene, {8, 0, 0}).boxes.size(), 2u);
    bvh::LeafItem placement;
    placement.placement = 0;
    const Bounds box{glm::vec3(-1), glm::vec3(1)};
    EXPECT_EQ(bvh::splitItems(Scene{}, std::vector{placement}, {box}, {8, 0, 0}).boxes.size(), 1u);
}

TEST(SplitItems, NoMoreThanAskedForAndNoneWithoutGain) {
    Random random(31);
    const Scene scene = beams(200, random);
    EXPECT_EQ(split(scene, {0, 0, 0}).boxes.size(), 200u);
    EXPECT_EQ(split(scene, {0.25, 0, 0}).boxes.size(), 250u);
    EXPECT_EQ(split(scene, {8, 0, 1e6}).boxes.size(), 200u);
    EXPECT_EQ(split(scene, {8, 0.9, 0}).boxes.size(), 200u);
}

/// Also where the triangle test, which strays by up to 8u of the triangle's extent, may see them.
TEST(SplitItems, PartsHoldTheTriangles) {
    Random random(32);
    const Scene scene = beams(50, random);
    const std::vector<bvh::LeafItem> items = bvh::makeLeafItems(scene);
    const ItemBoxes boxes = split(scene, {8, 0, 0});
    ASSERT_GT(boxes.boxes.size(), 400u);
    for (uint32_t item = 0; item < items.size(); ++item)
        for (const uint32_t triangle : items[item].primitive)
            for (int i = 0; i < 500; ++i) {
                const Triangle& t = scene.triangles[triangle];
                const double u = random.uniform(), v = random.uniform() * (1 - u);
                const glm::dvec3 a = scene.positions[t.corner[0]];
                const glm::dvec3 p = a + u * (glm::dvec3(scene.positions[t.corner[1]]) - a) +
                                     v * (glm::dvec3(scene.positions[t.corner[2]]) - a);
                const glm::dvec3 extent(bvh::itemBounds(scene, items)[item].extent());
                const glm::dvec3 strays(8 * 0x1p-24 * glm::compMax(extent));
                bool held = false;
                for (size_t box = 0; box < boxes.boxes.size(); ++box)
                    held |=
                        boxes.itemOf[box] == item &&
                        glm::all(glm::lessThanEqual(glm::dvec3(boxes.boxes[box].lo), p - strays)) &&
                        glm::all(glm::lessThanEqual(p + strays, glm::dvec3(boxes.boxes[box].hi)));
                ASSERT_TRUE(held) << item << ' ' << i;
            }
}

TEST(SplitItems, TheLayoutIsValidAndHasFewerVisits) {
    Random random(33);
    const Scene scene = beams(3000, random);
    BuildOptions often;
    often.split = {4, 0.3, 0};
    const WideLayout with = buildWideBvh(scene, often), without = buildWideBvh(scene, unsplit());
    expectValidLayout(with, scene);
    expectValidLayout(without, scene);
    EXPECT_LT(measure(with).expectedVisits, 0.7 * measure(without).expectedVisits);
    EXPECT_LE(with.records.size(), 5.5 * double(without.records.size()));
    expectValidLayout(buildWideBvh(scene), scene);
}

/// The triangles hit and the distances are those of the tree without copies, also where the ray
/// starts on a triangle, whose copies have to be passed over like itself.
TEST(SplitItems, RaysFindWhatTheyFindWithout) {
    Random random(34);
    const Scene scene = beams(1500, random);
    const Traceable with(scene), without(scene, unsplit());
    ASSERT_GT(with.layout.records.size(), without.layout.records.size());
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        TraversalRay ray;
        ray.origin = random.inCube(1);
        ray.direction = random.vector();
        for (int bounce = 0; bounce < 4; ++bounce) {
            const TraversalHit a = closestHit(with.layout, ray);
            TraversalRay same = ray;
            if (bounce > 0)
                same.skipPrimitive = without.layout.placeOf[with.primitiveAt[ray.skipPrimitive]];
            const TraversalHit b = closestHit(without.layout, same);
            ASSERT_EQ(a.t, b.t) << i;
            ASSERT_EQ(anyHit(with.layout, ray), bool(a));
            if (!a) break;
            ++hits;
            if (with.primitiveAt[a.primitive] != without.primitiveAt[b.primitive]) break; // a tie
            ray.origin += a.t * ray.direction; // on the triangle, or just beside it
            ray.skipPrimitive = a.primitive;
        }
    }
    EXPECT_GT(hits, 10000);
}

} // namespace
} // namespace stromboli::test
