// The layout of scenes with placements: what leads where, and that all triangles are found.

#include "host/bvh/node_record.hpp"
#include "host/bvh/statistics.hpp"
#include "host/bvh/wide_layout.hpp"
#include "host/core/random.hpp"
#include "scene/generate/hard_meshes.hpp"
#include "scene/model/placements.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace stromboli {
namespace {

/// Two prototypes, a triangle and a sphere in the world, and placements of both.
Scene someScene(uint32_t placements) {
    Random random(11);
    Scene scene = starMesh(2, random);
    const Scene other = starMesh(3, random);
    const auto corner = uint32_t(scene.positions.size());
    scene.prototypes = {{0, uint32_t(scene.triangles.size())},
                        {uint32_t(scene.triangles.size()), uint32_t(other.triangles.size())}};
    for (const Scene* mesh : {&other}) {
        scene.positions.insert(scene.positions.end(), mesh->positions.begin(),
                               mesh->positions.end());
        for (Triangle t : mesh->triangles) {
            for (uint32_t& c : t.corner)
                c += corner;
            scene.triangles.push_back(t);
        }
    }
    scene.triangles.push_back(scene.triangles[0]); // in the world
    scene.spheres.push_back({{5, 5, 5}, 1, 0, 0});
    for (uint32_t i = 0; i < placements; ++i) {
        Placement p = *placementOf(glm::translate(glm::dmat4(1), glm::dvec3(random.inCube(20.0f))));
        p.prototype = i % 2;
        scene.placements.push_back(p);
    }
    return scene;
}

/// Entries of the Primitive buffer that the leaves under a record name.
void collect(const WideLayout& layout, uint32_t record, std::vector<uint32_t>& entries,
             std::vector<uint32_t>& placements, uint32_t depth, uint32_t& deepest) {
    deepest = std::max(deepest, depth);
    const Record& r = layout.records.at(record);
    if (isPlacement(r)) return placements.push_back(asPlacement(r).placement & 0x7FFFFFFFu);
    if (!isNode(r)) {
        const gpu::LeafRecord leaf = asLeaf(r);
        const uint32_t first = leaf.primitive & gpu::RECORD_INDEX_MASK;
        entries.push_back(first);
        if (leaf.p3 != leaf.p2) entries.push_back(first + 1);
        return;
    }
    const gpu::NodeRecord node = asNode(r);
    for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
        if (!bvh::childBox(node, slot).empty())
            collect(layout, bvh::firstChild(node) + slot, entries, placements, depth + 1, deepest);
}

std::vector<uint32_t> numbersUnder(const WideLayout& layout, uint32_t record) {
    std::vector<uint32_t> entries, placements;
    uint32_t deepest = 0;
    collect(layout, record, entries, placements, 0, deepest);
    std::vector<uint32_t> numbers;
    for (const uint32_t entry : entries)
        numbers.push_back(layout.primitiveOrder.at(entry));
    std::ranges::sort(numbers);
    const auto copies = std::ranges::unique(numbers); // of leaves that are in several places
    numbers.erase(copies.begin(), copies.end());
    return numbers;
}

TEST(TwoLevels, EachPlacementLeadsToItsPrototype) {
    const Scene scene = someScene(100);
    const WideLayout layout = buildWideBvh(scene);
    ASSERT_EQ(layout.recordOfPlacement.size(), 100u);
    for (uint32_t i = 0; i < 100; ++i) {
        const Record& r = layout.records.at(layout.recordOfPlacement[i]);
        ASSERT_TRUE(isPlacement(r));
        const gpu::PlacementRecord p = asPlacement(r);
        EXPECT_EQ(p.placement, i);
        ASSERT_TRUE(isNode(layout.records.at(p.root)));
        const Prototype& prototype = scene.prototypes[i % 2];
        const std::vector<uint32_t> numbers = numbersUnder(layout, p.root);
        ASSERT_EQ(numbers.size(), prototype.triangles);
        EXPECT_EQ(numbers.front(), prototype.firstTriangle);
        EXPECT_EQ(numbers.back(), prototype.firstTriangle + prototype.triangles - 1);
        const auto transform = std::bit_cast<gpu::TransformRecord>(layout.records.at(p.transform));
        EXPECT_EQ(transform.toWorld0, scene.placements[i].toWorld[0]);
        EXPECT_EQ(glm::vec3(p.toPrototype1), glm::vec3(0, 1, 0));
        // 16 u, of a reach of 1.4 and a place of up to 20.
        EXPECT_NEAR(p.toPrototype1.w, 0x1p-20, 0x1p-39);
        const double place =
            std::max({std::abs(transform.toWorld0.w), std::abs(transform.toWorld1.w),
                      std::abs(transform.toWorld2.w)});
        EXPECT_NEAR(transform.reach, 2.25 * 1.3 + place / 16, 0.25);
    }
}

TEST(TwoLevels, TheWorldHasTheRest) {
    const Scene scene = someScene(100);
    const WideLayout layout = buildWideBvh(scene);
    std::vector<uint32_t> entries, placements;
    uint32_t deepest = 0;
    collect(layout, 0, entries, placements, 0, deepest);
    std::ranges::sort(placements);
    ASSERT_EQ(placements.size(), 100u);
    for (uint32_t i = 0; i < 100; ++i)
        EXPECT_EQ(placements[i], i);
    const auto triangles = uint32_t(scene.triangles.size());
    EXPECT_EQ(numbersUnder(layout, 0), (std::vector<uint32_t>{triangles - 1, triangles}));
    EXPECT_EQ(layout.placeOf.size(), triangles + 1u);
    const Record& leaf = layout.records.at(layout.placeOf[triangles - 1] / 2);
    EXPECT_EQ(asLeaf(leaf).p0,
              scene.positions[scene.triangles.back().corner[layout.firstCorner[triangles - 1]]]);
}

TEST(TwoLevels, StacksHoldBothTrees) {
    const Scene scene = someScene(100);
    const WideLayout layout = buildWideBvh(scene);
    std::vector<uint32_t> entries, placements;
    uint32_t world = 0, prototype = 0;
    collect(layout, 0, entries, placements, 0, world);
    for (const uint32_t record : layout.recordOfPlacement)
        collect(layout, asPlacement(layout.records[record]).root, entries, placements, 0,
                prototype);
    // A group waits at each level above a leaf, and one entry is written beyond them.
    EXPECT_GE(layout.stackSize, world + prototype);
}

/// A million of them would take 128 MB, and the nodes over them.
TEST(TwoLevels, APlacementTakesTwoRecordsAndAPartOfANode) {
    const WideLayout few = buildWideBvh(someScene(1000)), many = buildWideBvh(someScene(9000));
    const double bytes = double(many.records.size() - few.records.size()) * sizeof(Record) / 8000;
    EXPECT_GE(bytes, 128);
    EXPECT_LE(bytes, 128 + 32);
    EXPECT_EQ(measure(many).placements, 9000u);
}

} // namespace
} // namespace stromboli
