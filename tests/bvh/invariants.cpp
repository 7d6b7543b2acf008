#include "tests/bvh/invariants.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace stromboli::test {

namespace {

bool inside(const Bounds& inner, const Bounds& outer) {
    return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) &&
           glm::all(glm::lessThanEqual(inner.hi, outer.hi));
}

/// 0 where every number below order.size() occurs once.
size_t missingFromPermutation(const std::vector<uint32_t>& order) {
    std::vector<bool> seen(order.size(), false);
    for (const uint32_t i : order)
        if (i < seen.size()) seen[i] = true;
    return size_t(std::count(seen.begin(), seen.end(), false));
}

class TreeCheck {
  public:
    TreeCheck(const BinaryTree& tree, std::span<const Bounds> primitives,
              const BuildOptions& options)
        : tree_(tree), primitives_(primitives), options_(options) {}

    void run() {
        visit(0, 0);
        EXPECT_EQ(visited_, tree_.nodes.size()) << "nodes that no parent has";
        EXPECT_EQ(nextInOrder_, primitives_.size()) << "leaves must cover the order";
        EXPECT_EQ(tree_.order.size(), primitives_.size());
        EXPECT_EQ(missingFromPermutation(tree_.order), 0u);
        EXPECT_EQ(tree_.depth, deepest_);
        EXPECT_LE(tree_.depth, options_.depthCap);
    }

  private:
    /// Depth first, left before right; recursion is as deep as the tree.
    void visit(uint32_t index, uint32_t depth) {
        ASSERT_LT(index, tree_.nodes.size());
        const BinaryNode& node = tree_.nodes[index];
        ++visited_;
        deepest_ = std::max(deepest_, depth);
        if (node.count > 0) {
            visitLeaf(node);
            return;
        }
        for (const uint32_t child : {node.left, node.right}) {
            ASSERT_GT(child, index) << "children must follow their parent";
            visit(child, depth + 1);
            ASSERT_TRUE(inside(tree_.nodes[child].bounds, node.bounds)) << "node " << index;
        }
    }

    void visitLeaf(const BinaryNode& leaf) {
        ASSERT_LE(leaf.count, options_.maxLeafSize);
        ASSERT_EQ(leaf.first, nextInOrder_) << "leaves must follow each other in the order";
        nextInOrder_ += leaf.count;
        ASSERT_LE(nextInOrder_, tree_.order.size());
        Bounds all;
        for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
            all.extend(primitives_[tree_.order[i]]);
        ASSERT_EQ(all.lo, leaf.bounds.lo) << "a leaf's box must be tight";
        ASSERT_EQ(all.hi, leaf.bounds.hi) << "a leaf's box must be tight";
    }

    const BinaryTree& tree_;
    std::span<const Bounds> primitives_;
    const BuildOptions& options_;
    size_t visited_ = 0, nextInOrder_ = 0;
    uint32_t deepest_ = 0;
};

class LayoutCheck {
  public:
    LayoutCheck(const BinaryLayout& layout, const BinaryTree& tree)
        : layout_(layout), tree_(tree) {}

    void run() {
        EXPECT_EQ(layout_.primitiveOrder, tree_.order);
        const uint32_t mostPushed = visit(0, 0);
        EXPECT_EQ(next_, layout_.nodes.size());
        EXPECT_GE(layout_.stackSize, std::max(mostPushed, 1u));
    }

  private:
    /// Returns the most entries a traversal of this subtree can have on the stack at once, if it
    /// meets all boxes and takes the worse child first.
    uint32_t visit(uint32_t index, uint32_t treeNode) {
        EXPECT_EQ(index, next_++) << "layout must be depth first";
        const gpu::Node& node = layout_.nodes[index];
        const BinaryNode& inTree = tree_.nodes[treeNode];
        const uint32_t left = child(node.left, node.leftLow, node.leftHigh, inTree.left);
        const uint32_t right = child(node.right, node.rightLow, node.rightHigh, inTree.right);
        return 1 + std::max(left, right);
    }

    uint32_t child(uint32_t reference, const glm::vec3& low, const glm::vec3& high,
                   uint32_t treeNode) {
        const BinaryNode& expected = tree_.nodes[treeNode];
        EXPECT_EQ(low, expected.bounds.lo);
        EXPECT_EQ(high, expected.bounds.hi);
        const bool isLeaf = (reference & gpu::CHILD_LEAF_BIT) != 0;
        EXPECT_EQ(isLeaf, expected.count > 0);
        if (!isLeaf) return visit(reference, treeNode);
        EXPECT_EQ(reference & gpu::CHILD_FIRST_MASK, expected.first);
        EXPECT_EQ(((reference >> gpu::CHILD_COUNT_SHIFT) & 15u) + 1, expected.count);
        return 0;
    }

    const BinaryLayout& layout_;
    const BinaryTree& tree_;
    uint32_t next_ = 0;
};

} // namespace

void expectValidTree(const BinaryTree& tree, std::span<const Bounds> primitives,
                     const BuildOptions& options) {
    ASSERT_FALSE(tree.nodes.empty());
    TreeCheck(tree, primitives, options).run();
}

void expectValidLayout(const BinaryLayout& layout, const BinaryTree& tree) {
    ASSERT_GT(tree.nodes.size(), 1u) << "trees of one node are laid out otherwise";
    LayoutCheck(layout, tree).run();
}

} // namespace stromboli::test
