// Moving subtrees keeps the tree valid and never makes it dearer.

#include "host/bvh/reinsertion.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/invariants.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace stromboli::test {
namespace {

using namespace bvh;

double innerArea(const BinaryTree& tree) {
    double area = 0;
    for (const BinaryNode& node : tree.nodes)
        if (!node.isLeaf()) area += node.bounds.halfArea();
    return area;
}

BinaryTree withoutReinsertion(const std::vector<Bounds>& boxes) {
    return buildBinaryTree(boxes, {32, 48, false});
}

/// Returns the inner nodes' area afterwards, relative to that before.
double improvement(const std::vector<Bounds>& boxes) {
    BinaryTree tree = withoutReinsertion(boxes);
    const double before = innerArea(tree);
    reinsertSubtrees(tree, 48);
    expectValidTree(tree, boxes, 48);
    EXPECT_LE(innerArea(tree), before * (1 + 1e-6));
    return before > 0 ? innerArea(tree) / before : 1;
}

TEST(Reinsertion, KeepsTreesValidAndImprovesThem) {
    Random random(40);
    for (const uint32_t n : {1u, 2u, 3u, 4u, 5u, 20u, 1000u})
        improvement(boxesOf(soup(n, n / 2, 0.3f, random)));
    EXPECT_LT(improvement(boxesOf(starMesh(5, random))), 0.98);
    EXPECT_LT(improvement(boxesOf(clusterInSoup(random))), 0.99);
}

bool isAncestor(const LinkedTree& tree, uint32_t ancestor, uint32_t node) {
    while (node != LinkedTree::kNone && node != ancestor)
        node = tree[node].parent;
    return node == ancestor;
}

/// The most that moving one subtree beside any node, but for its own ancestors, gains.
double bestSingleMove(const BinaryTree& tree) {
    LinkedTree linked(tree);
    double best = 0;
    for (uint32_t subtree = 0; subtree < linked.size(); ++subtree)
        for (uint32_t beside = 0; beside < linked.size(); ++beside) {
            if (!linked.canMove(subtree, beside) || isAncestor(linked, beside, subtree)) continue;
            const uint32_t oldSibling = linked.sibling(subtree);
            best = std::max(best, -linked.move(subtree, beside));
            linked.move(subtree, oldSibling);
        }
    return best;
}

TEST(Reinsertion, LeavesNoMoveWorthItsWhile) {
    Random random(53);
    double before = 0, after = 0;
    for (int i = 0; i < 30; ++i) {
        BinaryTree tree = withoutReinsertion(boxesOf(soup(40, 0, 0.4f, random)));
        before = std::max(before, bestSingleMove(tree) / innerArea(tree));
        reinsertSubtrees(tree, 48);
        after = std::max(after, bestSingleMove(tree) / innerArea(tree));
    }
    std::cout << "best single move: " << before << " of the inner area, afterwards " << after
              << '\n';
    EXPECT_GT(before, 0.01);
    EXPECT_LT(after, 0.01) << "the least gain of a round";
}

TEST(Reinsertion, TakesTheWallsOfARoomAwayFromWhatIsInIt) {
    // Top-down splits put each wall, a fifth of the area, with whatever lies on its side.
    Scene scene = landscape(60);
    scale(scene, 0.5f);
    addRoom(scene);
    const double left = improvement(boxesOf(scene));
    std::cout << "mesh in a room: " << left << " of the inner area left\n";
    EXPECT_LT(left, 0.92);
}

TEST(Reinsertion, EqualBoxesAndBoxesWithoutArea) {
    EXPECT_EQ(improvement(std::vector<Bounds>(500, {{0, 0, 0}, {1, 1, 1}})), 1);
    EXPECT_EQ(improvement(std::vector<Bounds>(500, {{1, 1, 1}, {1, 1, 1}})), 1);
}

TEST(Reinsertion, LargestCoordinates) {
    Random random(41);
    Scene scene = soup(3000, 0, 0.9f, random);
    scale(scene, gpu::LARGEST_COORDINATE / 2);
    improvement(boxesOf(scene));
}

TEST(Reinsertion, TreeThatWouldGrowTooDeepStaysAsItIs) {
    Random random(42);
    const std::vector<Bounds> boxes = boxesOf(starMesh(5, random));
    BinaryTree free = withoutReinsertion(boxes);
    const uint32_t depth = free.depth;
    reinsertSubtrees(free, 256);
    ASSERT_GT(free.depth, depth) << "a blunt test: it does not get deeper";
    BinaryTree tree = withoutReinsertion(boxes);
    const double before = innerArea(tree);
    reinsertSubtrees(tree, depth);
    EXPECT_EQ(tree.depth, depth);
    EXPECT_EQ(innerArea(tree), before);
}

TEST(LinkedTree, MovesThereAndBack) {
    Random random(43);
    const std::vector<Bounds> boxes = boxesOf(soup(200, 0, 0.2f, random));
    const BinaryTree tree = withoutReinsertion(boxes);
    LinkedTree linked(tree);
    uint32_t moves = 0;
    for (int i = 0; i < 5000; ++i) {
        const uint32_t subtree = random.below(linked.size()), beside = random.below(linked.size());
        if (!linked.canMove(subtree, beside)) continue;
        const uint32_t oldSibling = linked.sibling(subtree);
        const double before = linked.innerArea();
        const double grown = linked.move(subtree, beside);
        EXPECT_NEAR(linked.innerArea(), before + grown, 1e-3 * before);
        EXPECT_EQ(linked.sibling(subtree), beside);
        ++moves;
        if (i % 2) { // back
            EXPECT_NEAR(linked.move(subtree, oldSibling), -grown, 1e-3 * before);
        }
    }
    EXPECT_GT(moves, 1000u);
    expectValidTree(linked.depthFirst(tree), boxes, 256);
}

TEST(LinkedTree, RefusesMovesThatWouldMakeNoTree) {
    const std::vector<Bounds> boxes(4, {{0, 0, 0}, {1, 1, 1}});
    const BinaryTree tree = withoutReinsertion(boxes); // 0 (1 (2 3) 4 (5 6))
    const LinkedTree linked(tree);
    EXPECT_FALSE(linked.canMove(0, 3)) << "the root";
    EXPECT_FALSE(linked.canMove(1, 5)) << "its parent is the root";
    EXPECT_FALSE(linked.canMove(2, 0)) << "beside the root";
    EXPECT_FALSE(linked.canMove(2, 1)) << "beside its parent";
    EXPECT_FALSE(linked.canMove(2, 3)) << "where it is";
    EXPECT_FALSE(linked.canMove(2, 2)) << "beside itself";
    EXPECT_TRUE(linked.canMove(2, 4));
    EXPECT_TRUE(linked.canMove(2, 5));
}

} // namespace
} // namespace stromboli::test
