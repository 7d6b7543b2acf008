// The light tree: its bounds hold what they bound, and every light is in it once, at the end of its
// trail.
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/light_tree.hpp"
#include "scene/generate/generated_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace stromboli {
namespace {

class LightTreeTest : public testing::Test {
  protected:
    LightTreeTest() {
        for (const Emitter& e : collectEmitters(scene))
            for (const uint32_t triangle : e.triangles)
                lights.push_back(boundsOfTriangle(scene, triangle));
        tree = buildLightTree(lights);
    }

    /// The lights below a node; checks the node on the way.
    std::vector<uint32_t> check(uint32_t index, uint32_t level, uint32_t trail) {
        const gpu::LightNode& node = tree.nodes.at(index);
        const uint32_t child = node.child & gpu::LIGHT_NODE_CHILD_MASK;
        std::vector<uint32_t> numbers;
        if (node.child & gpu::LIGHT_NODE_IS_LEAF) {
            EXPECT_GE(level + 1, tree.levels) << "the tree is balanced";
            EXPECT_EQ(tree.trails.at(child), trail);
            numbers.push_back(child);
        } else {
            numbers = check(child, level + 1, trail);
            const std::vector<uint32_t> right = check(child + 1, level + 1, trail | 1u << level);
            numbers.insert(numbers.end(), right.begin(), right.end());
        }
        expectBounds(node, numbers);
        return numbers;
    }

    void expectBounds(const gpu::LightNode& node, const std::vector<uint32_t>& numbers) {
        const glm::dvec3 axis = decodeNormal(node.axis);
        double power = 0;
        for (const uint32_t number : numbers) {
            const LightBounds& l = lights.at(number);
            power += l.power;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 p(corner & 1 ? l.lo.x : l.hi.x, corner & 2 ? l.lo.y : l.hi.y,
                                   corner & 4 ? l.lo.z : l.hi.z);
                EXPECT_LE(glm::length(p - glm::dvec3(node.center)) + l.reach, node.radius);
            }
            const double angle =
                std::acos(std::clamp(glm::dot(axis, l.axis), -1.0, 1.0)) + std::acos(l.cosSpread);
            EXPECT_LE(angle, std::acos(double(node.cosSpread)) + 1e-6);
            EXPECT_TRUE(!l.bothSides || (node.child & gpu::LIGHT_NODE_BOTH_SIDES));
            EXPECT_TRUE(l.sharp || !(node.child & gpu::LIGHT_NODE_SHARP));
        }
        EXPECT_NEAR(node.power / power, 1, 1e-6);
    }

    Scene scene = generatedScene("lamps:1000");
    std::vector<LightBounds> lights;
    LightTree tree;
};

TEST_F(LightTreeTest, BoundsHoldAndEveryLightIsInItOnce) {
    const std::vector<uint32_t> numbers = check(gpu::LIGHT_GROUP_NEAR, 0, 0);
    EXPECT_EQ(std::set<uint32_t>(numbers.begin(), numbers.end()).size(), 1000u);
    EXPECT_EQ(numbers.size(), 1000u);
    EXPECT_EQ(tree.levels, 10u);
    EXPECT_EQ(tree.groups, 1u << gpu::LIGHT_GROUP_NEAR);
}

TEST_F(LightTreeTest, OneLightIsATree) {
    const LightTree one = buildLightTree(std::span(lights).first(1));
    EXPECT_EQ(one.levels, 0u);
    EXPECT_TRUE(one.nodes[0].child & gpu::LIGHT_NODE_IS_LEAF);
}

Light lightOf(LightKind kind) {
    Light light;
    light.kind = kind;
    light.direction = {0, -1, 0};
    light.color = {2, 2, 2};
    return light;
}

/// Whether a point light falls off within the scene decides what it is compared with.
TEST(LightBounds, GroupsFollowTheFalloff) {
    Light point = lightOf(LightKind::Point);
    EXPECT_EQ(boundsOfLight(point, 10).group, gpu::LIGHT_GROUP_UNATTENUATED);
    EXPECT_NEAR(boundsOfLight(point, 10).power, 2, 1e-6);
    point.quadraticAttenuation = 1; // 1 + d^2
    EXPECT_EQ(boundsOfLight(point, 10).group, gpu::LIGHT_GROUP_NEAR);
    EXPECT_NEAR(boundsOfLight(point, 10).power, 2, 1e-6);
    EXPECT_NEAR(boundsOfLight(point, 10).reach, 1, 1e-12) << "no more than color / 1";
    EXPECT_EQ(boundsOfLight(point, 0.1).group, gpu::LIGHT_GROUP_UNATTENUATED) << "a small scene";
    EXPECT_EQ(boundsOfLight(lightOf(LightKind::Directional), 10).group, gpu::LIGHT_GROUP_INFINITE);
}

TEST_F(LightTreeTest, GroupsHaveTreesOfTheirOwn) {
    lights.push_back(boundsOfLight(lightOf(LightKind::Directional), 1));
    lights.push_back(boundsOfLight(lightOf(LightKind::Ambient), 1));
    lights.push_back(boundsOfLight(lightOf(LightKind::Point), 1));
    tree = buildLightTree(lights);
    EXPECT_EQ(tree.groups, 7u);
    EXPECT_EQ(check(gpu::LIGHT_GROUP_NEAR, 0, 0).size(), 1000u);
    const auto below = [&](uint32_t group) { return tree.nodes[group].child; };
    EXPECT_EQ(below(gpu::LIGHT_GROUP_UNATTENUATED), gpu::LIGHT_NODE_IS_LEAF | 1002u);
    EXPECT_FALSE(below(gpu::LIGHT_GROUP_INFINITE) & gpu::LIGHT_NODE_IS_LEAF);
}

} // namespace
} // namespace stromboli
