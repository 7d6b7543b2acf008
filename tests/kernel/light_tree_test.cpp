// The tree over emissive triangles: its bounds hold what they bound, and every triangle is in it
// once.
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/light_tree.hpp"
#include "scene/generate/generated_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace stromboli {
namespace {

class LightTreeTest : public testing::Test {
  protected:
    Scene scene = generatedScene("lamps:1000");
    std::vector<LightTriangle> triangles = lightTriangles(scene, collectEmitters(scene));
    LightTree tree = buildLightTree(triangles);
    std::map<uint32_t, LightTriangle> byId;
    std::map<uint32_t, double> probability; ///< of the alias tables, over that of the leaf

    void SetUp() override {
        for (const LightTriangle& t : triangles)
            byId[t.id] = t;
    }
    /// The triangles below a node; checks the node on the way.
    std::vector<uint32_t> check(uint32_t index, uint32_t level) {
        const gpu::LightNode& node = tree.nodes.at(index);
        const uint32_t child = node.child & gpu::LIGHT_NODE_CHILD_MASK;
        std::vector<uint32_t> ids;
        if (node.child & gpu::LIGHT_NODE_IS_LEAF) {
            const uint32_t count =
                node.child >> gpu::LIGHT_NODE_COUNT_SHIFT & gpu::LIGHT_NODE_MOST_TRIANGLES;
            EXPECT_GE(level + 1, tree.levels) << "the tree is balanced";
            for (uint32_t i = child; i < child + count; ++i) {
                const gpu::EmitterEntry& e = tree.entries.at(i);
                ids.push_back(e.place);
                probability[e.place] += double(e.threshold) / count;
                probability[e.alias] += (1 - double(e.threshold)) / count;
            }
        } else {
            ids = check(child, level + 1);
            const std::vector<uint32_t> right = check(child + 1, level + 1);
            ids.insert(ids.end(), right.begin(), right.end());
        }
        expectBounds(node, ids);
        return ids;
    }
    void expectBounds(const gpu::LightNode& node, const std::vector<uint32_t>& ids) {
        const glm::dvec3 axis = decodeNormal(node.axis);
        double power = 0;
        for (const uint32_t id : ids) {
            const LightTriangle& t = byId.at(id);
            power += t.power;
            for (const glm::dvec3& p : t.corner)
                EXPECT_LE(glm::length(p - glm::dvec3(node.center)), node.radius);
            const glm::dvec3 n =
                glm::normalize(glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
            EXPECT_GE(glm::dot(n, axis), node.cosSpread - 1e-7);
        }
        EXPECT_NEAR(node.power / power, 1, 1e-6);
        if (!(node.child & gpu::LIGHT_NODE_IS_LEAF)) return;
        for (const uint32_t id : ids) {
            EXPECT_NEAR(probability[id], byId.at(id).power / power, 1e-6);
        }
    }
};

TEST_F(LightTreeTest, BoundsHoldAndEveryTriangleIsInItOnce) {
    const std::vector<uint32_t> ids = check(0, 0);
    EXPECT_EQ(ids.size(), 1000u);
    EXPECT_EQ(probability.size(), 1000u);
    EXPECT_EQ(tree.levels, 7u); // 128 leaves of 7 or 8
    EXPECT_EQ(tree.nodes.size(), 2 * 128u - 1);
}

TEST_F(LightTreeTest, OneTriangleIsATree) {
    const LightTree one = buildLightTree({triangles[0]});
    EXPECT_EQ(one.nodes.size(), 1u);
    EXPECT_EQ(one.levels, 0u);
    EXPECT_TRUE(one.nodes[0].child & gpu::LIGHT_NODE_IS_LEAF);
}

TEST_F(LightTreeTest, FewTrianglesAreLightsOfTheirOwn) {
    const Scene few = generatedScene("lamps:56"), many = generatedScene("lamps:64");
    EXPECT_FALSE(haveManyTriangles(collectEmitters(few)));
    EXPECT_TRUE(haveManyTriangles(collectEmitters(many)));
}

} // namespace
} // namespace stromboli
