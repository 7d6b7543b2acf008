#include "host/bvh/primitive_bounds.hpp"
#include "host/bvh/statistics.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/sweep_builder.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace stromboli::test {
namespace {

TEST(Statistics, OfATreeByHand) {
    // Two unit cubes, 2 apart, in leaves of their own, one of which holds its cube twice.
    const std::vector<Bounds> boxes{
        {{0, 0, 0}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}};
    BuildOptions options;
    options.traversalCost = 0.5f;
    options.intersectionCost = 2;
    const BinaryTree tree = buildBinaryTree(boxes, options);
    const BinaryLayout layout = layOut(tree);
    const BvhStatistics s = measure(tree, layout, options);
    EXPECT_EQ(s.leavesOfSize[1], 1u + 2u * (s.leaves - 2));
    // A box of 4 x 1 x 1 has half area 9, a cube 3. The twins' leaf costs 2 * 2, as two leaves
    // under a node they would cost 0.5 + 2 * 2.
    EXPECT_EQ(s.nodes, 3u);
    EXPECT_EQ(s.leaves, 2u);
    EXPECT_EQ(s.depth, 1u);
    EXPECT_EQ(s.leavesOfSize[1], 1u);
    EXPECT_EQ(s.leavesOfSize[2], 1u);
    EXPECT_DOUBLE_EQ(s.sahCost, 0.5 + (3.0 / 9) * 2 + (3.0 / 9) * 4);
    EXPECT_EQ(s.layoutBytes, 64u + 3 * 4u);
}

TEST(Statistics, OfNothing) {
    const BinaryTree tree = buildBinaryTree({});
    const BvhStatistics s = measure(tree, layOut(tree), {});
    EXPECT_EQ(s.nodes, 1u);
    EXPECT_EQ(s.leaves, 1u);
    EXPECT_EQ(s.leavesOfSize[0], 1u);
    EXPECT_EQ(s.sahCost, 0);
}

TEST(Statistics, CostIsFiniteWithoutArea) {
    const std::vector<Bounds> points(9, {{1, 1, 1}, {1, 1, 1}});
    EXPECT_EQ(sahCost(buildBinaryTree(points), {}), 0);
}

/// Binning may cost at most a tenth over trying every split.
void expectCloseToSweep(const char* name, const Scene& scene) {
    for (const uint32_t maxLeafSize : {1u, 4u, 16u}) {
        BuildOptions options;
        options.maxLeafSize = maxLeafSize;
        const std::vector<Bounds> boxes = primitiveBounds(scene);
        const double binned = sahCost(buildBinaryTree(boxes, options), options);
        const double sweep = sweepSahCost(boxes, options);
        std::cout << name << ", leaves of " << maxLeafSize << ": binned " << binned << ", sweep "
                  << sweep << '\n';
        EXPECT_LE(binned, 1.1 * sweep) << name;
        EXPECT_GE(binned, 0.7 * sweep) << name << ": a cost this low is an error in counting it";
    }
}

TEST(SahQuality, CloseToFullSweep) {
    Random random(7);
    expectCloseToSweep("soup", soup(3000, 1000, 0.05f, random));
    expectCloseToSweep("large soup triangles", soup(1000, 0, 0.5f, random));
    expectCloseToSweep("star", starMesh(4, random));
    expectCloseToSweep("cube", cubeMesh(16));
    expectCloseToSweep("landscape", landscape(48));
    expectCloseToSweep("cluster in soup", clusterInSoup(random));
    expectCloseToSweep("slivers", sliverStrip(1000));
}

} // namespace
} // namespace stromboli::test
