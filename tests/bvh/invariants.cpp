#include "tests/bvh/invariants.hpp"

#include "host/bvh/leaf_items.hpp"
#include "host/bvh/node_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <vector>

namespace stromboli::test {

namespace {

Bounds joined(const Bounds& a, const Bounds& b) {
    Bounds both = a;
    both.extend(b);
    return both;
}

class TreeCheck {
  public:
    TreeCheck(const BinaryTree& tree, std::span<const Bounds> items)
        : tree_(tree), items_(items), leavesOf_(items.size(), 0) {}

    void run(uint32_t depthCap) {
        ASSERT_EQ(tree_.nodes.size(), 2 * items_.size() - 1);
        visit(0, 0);
        EXPECT_EQ(visited_, tree_.nodes.size()) << "nodes that no parent has";
        EXPECT_EQ(std::count(leavesOf_.begin(), leavesOf_.end(), 1), std::ptrdiff_t(items_.size()));
        EXPECT_EQ(tree_.depth, deepest_);
        EXPECT_LE(tree_.depth, depthCap);
    }

  private:
    /// Depth first, left before right; recursion is as deep as the tree.
    void visit(uint32_t index, uint32_t depth) {
        ASSERT_EQ(index, visited_++) << "nodes must be depth first";
        ASSERT_LT(index, tree_.nodes.size());
        deepest_ = std::max(deepest_, depth);
        const BinaryNode& node = tree_.nodes[index];
        Bounds expected;
        if (node.isLeaf()) {
            ASSERT_LT(node.left, items_.size());
            ++leavesOf_[node.left];
            expected = items_[node.left];
        } else {
            visit(node.left, depth + 1);
            visit(node.right, depth + 1);
            if (testing::Test::HasFatalFailure()) return;
            expected = joined(tree_.nodes[node.left].bounds, tree_.nodes[node.right].bounds);
        }
        ASSERT_EQ(expected.lo, node.bounds.lo) << "a box must be tight";
        ASSERT_EQ(expected.hi, node.bounds.hi) << "a box must be tight";
    }

    const BinaryTree& tree_;
    std::span<const Bounds> items_;
    std::vector<int> leavesOf_; ///< by item: leaves that hold it
    size_t visited_ = 0;
    uint32_t deepest_ = 0;
};

class LayoutCheck {
  public:
    LayoutCheck(const WideLayout& layout, const Scene& scene)
        : layout_(layout), scene_(scene), timesReached_(layout.records.size(), 0) {}

    void run() {
        const size_t primitives = scene_.triangles.size() + scene_.spheres.size();
        ASSERT_FALSE(layout_.records.empty());
        ASSERT_TRUE(isNode(layout_.records[0]));
        ASSERT_EQ(layout_.primitiveOrder.size(), primitives);
        ASSERT_EQ(layout_.placeOf.size(), primitives);
        ASSERT_EQ(layout_.firstCorner.size(), primitives);
        for (uint32_t i = 0; i < layout_.records.size(); ++i)
            if (isCopy(i)) split_.insert(asLeaf(layout_.records[i]).homeOrRadius);
        visit(0, 0, bvh::GridBox{glm::dvec3(-1e300), glm::dvec3(1e300)});
        EXPECT_EQ(primitivesSeen_, primitives);
        for (const uint32_t home : split_)
            expectCovered(home);
        EXPECT_LE(*std::max_element(timesReached_.begin(), timesReached_.end()), 1);
        EXPECT_EQ(layout_.stackSize, deepestNode_ + 1);
    }

  private:
    /// Whether the record is a leaf whose triangles have another one for their home.
    bool isCopy(uint32_t index) const {
        const Record& record = layout_.records[index];
        if (isNode(record) || isPlacement(record)) return false;
        const gpu::LeafRecord leaf = asLeaf(record);
        const bool isSphere = (leaf.primitive & gpu::RECORD_IS_SPHERE) != 0;
        const bool isGap = leaf.p0 == leaf.p1 && leaf.p1 == leaf.p2 && leaf.homeOrRadius == 0;
        return !isSphere && !isGap && leaf.homeOrRadius != index;
    }

    /// `reached`: where all boxes on the way to the record are. Returns the box of all primitives
    /// below that have one leaf.
    Bounds visit(uint32_t index, uint32_t depth, const bvh::GridBox& reached) {
        EXPECT_LT(index, layout_.records.size());
        ++timesReached_.at(index);
        const Record& record = layout_.records.at(index);
        return isNode(record) ? visitNode(asNode(record), depth, reached)
                              : visitLeaf(asLeaf(record), index, reached);
    }

    Bounds visitNode(const gpu::NodeRecord& node, uint32_t depth, const bvh::GridBox& reached) {
        deepestNode_ = std::max(deepestNode_, depth);
        Bounds all;
        for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot) {
            const uint32_t child = bvh::firstChild(node) + slot;
            const bvh::GridBox box = bvh::childBox(node, slot);
            if (box.empty()) {
                expectHarmless(child);
                EXPECT_TRUE(glm::all(glm::greaterThan(box.lo, box.hi))) << "inverted on each axis";
                continue;
            }
            const bvh::GridBox there{glm::max(box.lo, reached.lo), glm::min(box.hi, reached.hi)};
            const Bounds inside = visit(child, depth + 1, there);
            expectHolds(node, box, inside);
            all.extend(inside);
        }
        return all;
    }

    /// A record that a ray may visit by way of an absent child.
    void expectHarmless(uint32_t record) const {
        ASSERT_LT(record, layout_.records.size());
        EXPECT_FALSE(isNode(layout_.records[record]));
    }

    /// Exact: long double has the bits for a sum of numbers that are 2^63 apart.
    static void expectHolds(const gpu::NodeRecord& node, const bvh::GridBox& box,
                            const Bounds& inside) {
        const uint32_t words[3] = {node.originAndExponentX, node.originAndExponentY,
                                   node.originAndExponentZ};
        for (int axis = 0; axis < 3; ++axis) {
            const long double margin =
                gpu::BOX_MARGIN * std::ldexp(1.0L, int(words[axis] & 255u) - 127);
            EXPECT_LE(box.lo[axis] + margin, (long double)inside.lo[axis]);
            EXPECT_GE(box.hi[axis] - margin, (long double)inside.hi[axis]);
        }
    }

    Bounds visitLeaf(const gpu::LeafRecord& leaf, uint32_t record, const bvh::GridBox& reached) {
        const bool isSphere = (leaf.primitive & gpu::RECORD_IS_SPHERE) != 0;
        const bool isSplit = !isSphere && split_.contains(leaf.homeOrRadius);
        if (isSplit) parts_[leaf.homeOrRadius].push_back(reached);
        if (isCopy(record)) return expectCopy(leaf), Bounds{};
        const uint32_t entry = leaf.primitive & gpu::RECORD_INDEX_MASK;
        Bounds inside;
        for (uint32_t slot = 0; slot < 2; ++slot) {
            if (entry + slot >= layout_.primitiveOrder.size()) break;
            const uint32_t primitive = layout_.primitiveOrder[entry + slot];
            if (layout_.placeOf[primitive] != 2 * record + slot) {
                EXPECT_EQ(slot, 1u) << "a leaf must hold a primitive";
                continue;
            }
            ++primitivesSeen_;
            if (!isSplit) inside.extend(primitiveBounds(scene_, primitive));
            EXPECT_EQ(isSphere, primitive >= scene_.triangles.size());
            isSphere ? expectSphere(leaf, primitive) : expectTriangle(leaf, slot, primitive);
        }
        return inside;
    }

    /// Geometry and numbers of its home.
    void expectCopy(const gpu::LeafRecord& leaf) const {
        gpu::LeafRecord home = asLeaf(layout_.records.at(leaf.homeOrRadius));
        home.light0 = leaf.light0, home.light1 = leaf.light1;
        EXPECT_EQ(std::bit_cast<Record>(leaf), std::bit_cast<Record>(home));
    }

    /// Every point of the triangles of a leaf with copies is where the way to one of these leads.
    void expectCovered(uint32_t home) {
        const gpu::LeafRecord leaf = asLeaf(layout_.records.at(home));
        const std::vector<bvh::GridBox>& parts = parts_[home];
        EXPECT_GE(parts.size(), 2u);
        const auto inside = [](const bvh::GridBox& box, const glm::dvec3& p) {
            return glm::all(glm::lessThanEqual(box.lo, p)) &&
                   glm::all(glm::lessThanEqual(p, box.hi));
        };
        constexpr int kSteps = 24;
        const glm::dvec3 p0 = leaf.p0, p2 = leaf.p2;
        for (const glm::dvec3 other : {glm::dvec3(leaf.p1), glm::dvec3(leaf.p3)})
            for (int i = 0; i <= kSteps; ++i)
                for (int k = 0; i + k <= kSteps; ++k) {
                    const glm::dvec3 p =
                        p0 + (p2 - p0) * (i / double(kSteps)) + (other - p0) * (k / double(kSteps));
                    EXPECT_TRUE(
                        std::ranges::any_of(parts, [&](const auto& b) { return inside(b, p); }))
                        << "leaf " << home << ", point " << i << ' ' << k;
                }
    }

    void expectTriangle(const gpu::LeafRecord& leaf, uint32_t slot, uint32_t primitive) const {
        const glm::vec3 corners[2][3] = {{leaf.p0, leaf.p1, leaf.p2}, {leaf.p0, leaf.p2, leaf.p3}};
        const Triangle& t = scene_.triangles[primitive];
        for (uint32_t c = 0; c < 3; ++c)
            EXPECT_EQ(corners[slot][c],
                      scene_.positions[t.corner[(c + layout_.firstCorner[primitive]) % 3]]);
    }

    void expectSphere(const gpu::LeafRecord& leaf, uint32_t primitive) const {
        const Sphere& s = scene_.spheres[primitive - scene_.triangles.size()];
        EXPECT_EQ(std::bit_cast<float>(leaf.homeOrRadius), s.radius);
        EXPECT_EQ(leaf.p0, s.center);
        EXPECT_EQ(leaf.p1, s.center);
        EXPECT_EQ(leaf.p2, s.center);
        EXPECT_EQ(leaf.p3, s.center);
    }

    const WideLayout& layout_;
    const Scene& scene_;
    std::vector<int> timesReached_;                       ///< by record
    std::set<uint32_t> split_;                            ///< homes of leaves with copies
    std::map<uint32_t, std::vector<bvh::GridBox>> parts_; ///< by home: where rays reach its leaves
    size_t primitivesSeen_ = 0;
    uint32_t deepestNode_ = 0;
};

} // namespace

void expectValidTree(const BinaryTree& tree, std::span<const Bounds> items, uint32_t depthCap) {
    ASSERT_FALSE(items.empty());
    TreeCheck(tree, items).run(depthCap);
}

void expectValidLayout(const WideLayout& layout, const Scene& scene) {
    LayoutCheck(layout, scene).run();
}

} // namespace stromboli::test
