// The collapse is the cheapest there is: against trying every choice of nodes.

#include "host/bvh/wide_tree.hpp"
#include "tests/bvh/fixtures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace stromboli::test {
namespace {

using namespace bvh;

/// Number of records below `node` that its own record would have as children, where `isRecord`
/// says which inner nodes are records.
uint32_t childrenOf(const BinaryTree& tree, uint32_t node, const std::vector<bool>& isRecord) {
    uint32_t count = 0;
    for (const uint32_t child : {tree.nodes[node].left, tree.nodes[node].right})
        count +=
            tree.nodes[child].isLeaf() || isRecord[child] ? 1 : childrenOf(tree, child, isRecord);
    return count;
}

/// Area of all records together for the best choice of inner nodes.
double leastAreaByTryingAll(const BinaryTree& tree) {
    std::vector<uint32_t> inner;
    double leaves = 0;
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
        if (i > 0 && !tree.nodes[i].isLeaf()) inner.push_back(i);
        if (tree.nodes[i].isLeaf()) leaves += tree.nodes[i].bounds.halfArea();
    }
    double least = 1e30;
    for (uint32_t choice = 0; choice < 1u << inner.size(); ++choice) {
        std::vector<bool> isRecord(tree.nodes.size(), false);
        double area = leaves + tree.nodes[0].bounds.halfArea();
        isRecord[0] = true;
        for (size_t i = 0; i < inner.size(); ++i)
            if (choice >> i & 1) {
                isRecord[inner[i]] = true;
                area += tree.nodes[inner[i]].bounds.halfArea();
            }
        bool valid = true;
        for (uint32_t i = 0; i < tree.nodes.size(); ++i)
            if (isRecord[i]) valid &= childrenOf(tree, i, isRecord) <= gpu::WIDE_CHILDREN;
        if (valid) least = std::min(least, area);
    }
    return least;
}

double areaOf(const BinaryTree& tree, const std::vector<WideNode>& nodes) {
    double area = tree.nodes[0].bounds.halfArea();
    for (const WideNode& node : nodes)
        for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
            if (node.has(slot)) area += tree.nodes[node.child[slot]].bounds.halfArea();
    return area;
}

TEST(Collapse, CheaperThanAnyOtherChoice) {
    Random random(37);
    for (int i = 0; i < 40; ++i) {
        const uint32_t n = 2 + random.below(14);
        const Scene scene = soup(n, 0, random.uniform(0.05f, 1.0f), random);
        const BinaryTree tree = buildBinaryTree(boxesOf(scene), {32, 48, i % 2 == 0});
        const double expected = leastAreaByTryingAll(tree);
        EXPECT_NEAR(areaOf(tree, collapse(tree)), expected, 1e-5 * expected) << n;
    }
}

/// Walks the nodes depth first by the children's masks alone.
void expectDepthFirst(const BinaryTree& tree, const std::vector<WideNode>& nodes) {
    std::vector<uint32_t> pending{0};
    std::set<uint32_t> leaves;
    for (const WideNode& node : nodes) {
        ASSERT_FALSE(pending.empty());
        const BinaryNode& root = tree.nodes[pending.back()];
        pending.pop_back();
        Bounds all;
        for (uint32_t slot = gpu::WIDE_CHILDREN; slot-- > 0;) {
            if (!node.has(slot)) continue;
            all.extend(tree.nodes[node.child[slot]].bounds);
            if (node.isNode(slot))
                pending.push_back(node.child[slot]);
            else
                EXPECT_TRUE(leaves.insert(node.child[slot]).second);
        }
        EXPECT_EQ(all.lo, root.bounds.lo);
        EXPECT_EQ(all.hi, root.bounds.hi);
        EXPECT_GE(std::popcount(uint32_t(node.nodes | node.leaves)), 2);
    }
    EXPECT_TRUE(pending.empty());
    EXPECT_EQ(leaves.size(), (tree.nodes.size() + 1) / 2);
}

TEST(Collapse, NodesAreDepthFirst) {
    Random random(38);
    for (const uint32_t n : {2u, 9u, 500u, 30000u}) { // the last is divided among tasks
        const BinaryTree tree = buildBinaryTree(boxesOf(soup(n, 0, 0.02f, random)));
        expectDepthFirst(tree, collapse(tree));
    }
}

TEST(Collapse, OfNothingAndOfOneLeafHasARoot) {
    const auto nothing = collapse(buildBinaryTree({}));
    ASSERT_EQ(nothing.size(), 1u);
    EXPECT_EQ(nothing[0].nodes | nothing[0].leaves, 0);
    const auto one = collapse(buildBinaryTree(std::vector<Bounds>(1, {{0, 0, 0}, {1, 1, 1}})));
    ASSERT_EQ(one.size(), 1u);
    EXPECT_TRUE(one[0].isLeaf(0));
    EXPECT_EQ(one[0].child[0], 0u);
}

TEST(Collapse, SumsOfTheLargestAreasStayInRange) {
    // Areas of 2^122 or so: hundreds of them together are beyond float.
    Random random(39);
    Scene scene = soup(2000, 0, 0.9f, random);
    scale(scene, gpu::LARGEST_COORDINATE / 2);
    const BinaryTree tree = buildBinaryTree(boxesOf(scene));
    expectDepthFirst(tree, collapse(tree));
    Scene small = scene;
    scale(small, 0x1p-59f);
    const BinaryTree sameShape = buildBinaryTree(boxesOf(small));
    EXPECT_EQ(collapse(tree).size(), collapse(sameShape).size());
}

} // namespace
} // namespace stromboli::test
