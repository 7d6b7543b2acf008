// The light tree: its bounds hold what they bound, and every light is in it once, at the end of its
// trail.
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/light_kinds.hpp"
#include "host/kernel/light_tree.hpp"
#include "scene/generate/generated_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace stromboli {
namespace {

class LightTreeTest : public testing::Test {
  protected:
    LightTreeTest() {
        for (const Emitter& e : collectEmitters(scene))
            for (const uint32_t triangle : e.triangles)
                lights.push_back(boundsOfTriangle(scene, triangle, MeanEmission(scene)));
        tree = buildLightTree(lights);
    }

    /// The lights below a node of a group, by the numbers the tree gives them; checks the node on
    /// the way.
    std::vector<uint32_t> check(uint32_t group, uint32_t node = 1, uint32_t level = 0,
                                uint32_t trail = 0) {
        uint32_t firstLight = 0;
        for (uint32_t g = 0; g < group; ++g)
            firstLight += tree.lightsInGroup[g];
        const uint32_t count = tree.lightsInGroup[group];
        std::vector<uint32_t> numbers;
        if (node >= count) {
            EXPECT_GE(level + 1, uint32_t(std::bit_width(count - 1))) << "the tree is balanced";
            numbers.push_back(firstLight + node - count);
            EXPECT_EQ(tree.trails.at(numbers[0]), trail);
            EXPECT_EQ(lights.at(tree.order.at(numbers[0])).group, group);
        } else {
            numbers = check(group, 2 * node, level + 1, trail);
            const std::vector<uint32_t> right =
                check(group, 2 * node + 1, level + 1, trail | 1u << level);
            numbers.insert(numbers.end(), right.begin(), right.end());
        }
        expectBounds(tree.nodes.at(2 * firstLight + node), numbers);
        return numbers;
    }

    void expectBounds(const gpu::LightNode& node, const std::vector<uint32_t>& numbers) {
        const glm::dvec3 axis = decodeNormal(node.axis);
        const double radius = std::bit_cast<float>(node.radiusAndPower & 0xFFFF0000u);
        const double rounded = std::bit_cast<float>(node.radiusAndPower << 16);
        double power = 0;
        for (const uint32_t number : numbers) {
            const LightBounds& l = lights.at(tree.order.at(number));
            power += l.power;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 p(corner & 1 ? l.lo.x : l.hi.x, corner & 2 ? l.lo.y : l.hi.y,
                                   corner & 4 ? l.lo.z : l.hi.z);
                EXPECT_LE(glm::length(p - glm::dvec3(node.center)) + l.reach, radius);
            }
            const double angle =
                std::acos(std::clamp(glm::dot(axis, l.axis), -1.0, 1.0)) + std::acos(l.cosSpread);
            EXPECT_LE(angle, std::acos(double(node.cosSpread)) + 1e-6);
            EXPECT_TRUE(!l.bothSides || (node.flags & gpu::LIGHT_NODE_BOTH_SIDES));
            EXPECT_TRUE(l.sharp || !(node.flags & gpu::LIGHT_NODE_SHARP));
        }
        // An eighth bit of precision is the last of a float's upper half.
        EXPECT_GE(rounded, power);
        EXPECT_LE(rounded, power * (1 + 0x1p-7));
    }

    Scene scene = generatedScene("lamps:1000");
    std::vector<LightBounds> lights;
    LightTree tree;
};

TEST_F(LightTreeTest, BoundsHoldAndEveryLightIsInItOnce) {
    const std::vector<uint32_t> numbers = check(gpu::LIGHT_GROUP_NEAR);
    EXPECT_EQ(std::set<uint32_t>(numbers.begin(), numbers.end()).size(), 1000u);
    EXPECT_EQ(numbers.size(), 1000u);
    EXPECT_EQ(std::set<uint32_t>(tree.order.begin(), tree.order.end()).size(), 1000u);
    EXPECT_EQ(tree.levels, 10u);
    EXPECT_EQ(tree.groups, 1u << gpu::LIGHT_GROUP_NEAR);
}

/// Whatever the number of lights: the deepest level is filled from the left.
TEST_F(LightTreeTest, AnyNumberOfLights) {
    const std::vector<LightBounds> all = lights;
    for (uint32_t n = 1; n < 70; ++n) {
        lights.assign(all.begin(), all.begin() + n);
        tree = buildLightTree(lights);
        const std::vector<uint32_t> numbers = check(gpu::LIGHT_GROUP_NEAR);
        EXPECT_EQ(std::set<uint32_t>(numbers.begin(), numbers.end()).size(), n);
        EXPECT_EQ(tree.nodes.size(), 2 * n);
        EXPECT_EQ(tree.levels, uint32_t(std::bit_width(n - 1))) << n;
    }
}

/// Powers that are not floats keep their order, and none becomes 0 or infinite.
TEST_F(LightTreeTest, PowersOfAnySize) {
    for (const double power : {1e-320, 1e-40, 1e-30, 1.0, 1e30, 1e39, 1e300}) {
        lights[0].power = power;
        const LightTree one = buildLightTree(std::span(lights).first(1));
        const float stored = std::bit_cast<float>(one.nodes[1].radiusAndPower << 16);
        EXPECT_TRUE(std::isnormal(stored)) << power;
        if (power > 1e-37 && power < 1e38) {
            EXPECT_NEAR(stored / power, 1, 0x1p-7);
        }
    }
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
    EXPECT_EQ(packLight(point, 10).bounds.group, gpu::LIGHT_GROUP_UNATTENUATED);
    EXPECT_NEAR(packLight(point, 10).bounds.power, 2, 1e-6);
    point.quadraticAttenuation = 1; // 1 + d^2
    EXPECT_EQ(packLight(point, 10).bounds.group, gpu::LIGHT_GROUP_NEAR);
    EXPECT_NEAR(packLight(point, 10).bounds.power, 2, 1e-6);
    EXPECT_NEAR(packLight(point, 10).bounds.reach, 1, 1e-12) << "no more than color / 1";
    EXPECT_EQ(packLight(point, 0.1).bounds.group, gpu::LIGHT_GROUP_UNATTENUATED) << "a small scene";
    EXPECT_EQ(packLight(lightOf(LightKind::Directional), 10).bounds.group,
              gpu::LIGHT_GROUP_INFINITE);
}

TEST_F(LightTreeTest, GroupsHaveTreesOfTheirOwn) {
    lights.push_back(packLight(lightOf(LightKind::Directional), 1).bounds);
    lights.push_back(packLight(lightOf(LightKind::Ambient), 1).bounds);
    lights.push_back(packLight(lightOf(LightKind::Point), 1).bounds);
    tree = buildLightTree(lights);
    EXPECT_EQ(tree.groups, 7u);
    EXPECT_EQ(tree.lightsInGroup, (std::array<uint32_t, 3>{1000, 1, 2}));
    EXPECT_EQ(check(gpu::LIGHT_GROUP_NEAR).size(), 1000u);
    EXPECT_EQ(check(gpu::LIGHT_GROUP_UNATTENUATED), std::vector<uint32_t>{1000});
    EXPECT_EQ(tree.order.at(1000), 1002u);
    EXPECT_EQ(check(gpu::LIGHT_GROUP_INFINITE).size(), 2u);
}

} // namespace
} // namespace stromboli
