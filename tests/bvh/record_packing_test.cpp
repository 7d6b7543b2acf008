#include "host/bvh/node_record.hpp"
#include "host/core/random.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace stromboli::test {
namespace {

using namespace bvh;

/// A random tree of nodes with at least two children, depth first.
std::vector<WideNode> randomTree(uint32_t leastNodes, Random& random) {
    std::vector<WideNode> nodes;
    for (uint32_t pending = 1; pending > 0; --pending) {
        WideNode node;
        const bool ends = nodes.size() + pending > leastNodes;
        while (std::popcount(uint32_t(node.nodes | node.leaves)) < 2)
            for (uint32_t slot = 0; slot < 8; ++slot) {
                const uint32_t kind = random.below(4); // one in four is absent
                const uint8_t bit = uint8_t(1u << slot);
                if (node.has(slot) || kind == 0) continue;
                (kind == 1 && !ends ? node.nodes : node.leaves) |= bit;
            }
        pending += uint32_t(std::popcount(uint32_t(node.nodes)));
        nodes.push_back(node);
    }
    return nodes;
}

TEST(RecordPacking, NothingOverlapsAndNoAbsentChildIsANode) {
    Random random(32);
    enum Kind { kFree, kNode, kLeaf };
    for (const uint32_t size : {1u, 10u, 1000u, 20000u}) {
        const std::vector<WideNode> nodes = randomTree(size, random);
        const RecordPacking packing = packRecords(nodes);
        ASSERT_EQ(packing.places.size(), nodes.size());
        std::vector<Kind> kinds(packing.records, kFree);
        kinds.at(0) = kNode;
        for (size_t i = 0; i < nodes.size(); ++i)
            for (uint32_t slot = 0; slot < 8; ++slot) {
                if (!nodes[i].has(slot)) continue;
                Kind& kind = kinds.at(packing.places[i].firstChild + slot);
                EXPECT_EQ(kind, kFree);
                kind = nodes[i].isNode(slot) ? kNode : kLeaf;
            }
        for (size_t i = 0; i < nodes.size(); ++i) {
            EXPECT_EQ(kinds.at(packing.places[i].record), kNode);
            for (uint32_t slot = 0; slot < 8; ++slot)
                if (!nodes[i].has(slot)) {
                    EXPECT_NE(kinds.at(packing.places[i].firstChild + slot), kNode);
                }
        }
    }
}

TEST(RecordPacking, ChildrenLieNearTheirElderSiblingsAndGapsAreFew) {
    Random random(33);
    const std::vector<WideNode> nodes = randomTree(20000, random);
    const RecordPacking packing = packRecords(nodes);
    uint32_t records = 1, last = 0;
    for (size_t i = 0; i < nodes.size(); ++i) {
        records += uint32_t(std::popcount(uint32_t(nodes[i].nodes | nodes[i].leaves)));
        EXPECT_GT(packing.places[i].firstChild + 256, last) << "outside the window";
        last = std::max(last, packing.places[i].firstChild);
    }
    // A quarter of the slots are absent: without filling gaps there would be a third more.
    EXPECT_LT(packing.records, 1.22 * records);
}

TEST(RecordPacking, RecordsFollowTheTreeDepthFirst) {
    // root: node in slot 2, leaf in slot 5; the node: two leaves.
    WideNode root, child;
    root.nodes = 1u << 2, root.leaves = 1u << 5;
    child.leaves = 0b11;
    const std::vector<WideNode> nodes{root, child};
    const RecordPacking packing = packRecords(nodes);
    EXPECT_EQ(packing.places[0].record, 0u);
    EXPECT_EQ(packing.places[1].record, packing.places[0].firstChild + 2);
    EXPECT_EQ(packing.depth, 1u);
}

} // namespace
} // namespace stromboli::test
