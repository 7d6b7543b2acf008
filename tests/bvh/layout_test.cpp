#include "host/bvh/binary_layout.hpp"
#include "host/bvh/cpu_traversal.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/invariants.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

void expectAbsent(uint32_t reference, const glm::vec3& low, const glm::vec3& high) {
    EXPECT_EQ(reference, gpu::CHILD_NONE);
    EXPECT_EQ(low, glm::vec3(gpu::LARGEST_COORDINATE));
    EXPECT_EQ(high, glm::vec3(-gpu::LARGEST_COORDINATE));
}

TEST(Layout, OfNothingHasARootWithoutChildren) {
    const BinaryLayout layout = layOut(buildBinaryTree({}));
    ASSERT_EQ(layout.nodes.size(), 1u);
    const gpu::Node& root = layout.nodes[0];
    expectAbsent(root.left, root.leftLow, root.leftHigh);
    expectAbsent(root.right, root.rightLow, root.rightHigh);
    EXPECT_TRUE(layout.primitiveOrder.empty());
    EXPECT_EQ(layout.stackSize, 1u);
    EXPECT_FALSE(closestHit(layout, {}, {}));
    EXPECT_FALSE(anyHit(layout, {}, {}));
}

TEST(Layout, OfOneLeafHasItOnTheLeft) {
    BinaryTree tree;
    tree.nodes.push_back({{{1, 2, 3}, {4, 5, 6}}, 0, 0, 0, 16});
    tree.order.resize(16);
    const BinaryLayout layout = layOut(tree);
    ASSERT_EQ(layout.nodes.size(), 1u);
    const gpu::Node& root = layout.nodes[0];
    EXPECT_EQ(root.left, 0x80000000u | 15u << 27);
    EXPECT_EQ(root.leftLow, glm::vec3(1, 2, 3));
    EXPECT_EQ(root.leftHigh, glm::vec3(4, 5, 6));
    expectAbsent(root.right, root.rightLow, root.rightHigh);
    EXPECT_EQ(layout.stackSize, 1u);
}

TEST(Layout, LastReferenceIsNotTakenForAnAbsentChild) {
    // The last primitive of the largest scene, in a leaf alone.
    BinaryTree tree;
    const Bounds unit{{0, 0, 0}, {1, 1, 1}};
    tree.nodes = {{unit, 1, 2, 0, 0}, {unit, 0, 0, 0, 1}, {unit, 0, 0, (1u << 27) - 1, 1}};
    tree.depth = 1;
    const gpu::Node root = layOut(tree).nodes.at(0);
    EXPECT_EQ(root.left, 0x80000000u);
    EXPECT_EQ(root.right, 0x87FFFFFFu);
    EXPECT_NE(root.right, gpu::CHILD_NONE);
}

TEST(Layout, OfManyPrimitivesMatchesTheTree) {
    Random random(8);
    for (const uint32_t maxLeafSize : {1u, 4u, 16u}) {
        BuildOptions options;
        options.maxLeafSize = maxLeafSize;
        const Traceable t(soup(700, 300, 0.1f, random), options);
        expectValidLayout(t.layout, t.tree);
    }
}

TEST(Layout, AbsentChildIsHitByNoRay) {
    // One leaf: rays along and against every axis and diagonal must find it past its sibling.
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
                EXPECT_EQ(closestHit(t.layout, t.primitives, ray).primitive, 0u);
                EXPECT_TRUE(anyHit(t.layout, t.primitives, ray));
                ray.direction = -d;
                EXPECT_FALSE(closestHit(t.layout, t.primitives, ray));
                EXPECT_FALSE(anyHit(t.layout, t.primitives, ray));
            }
}

} // namespace
} // namespace stromboli::test
