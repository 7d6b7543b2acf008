// The host's side of the kernel: work order, pace of dispatches, alias tables, features.
#include "host/bvh/binary_tree.hpp"
#include "host/bvh/primitive_bounds.hpp"
#include "host/kernel/alias_table.hpp"
#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/work_order.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

namespace stromboli {
namespace {

TEST(WorkOrder, IsAPermutationThatSpreadsHalves) {
    constexpr uint32_t kWidth = 100, kHeight = 60;
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < kWidth * kHeight; ++i)
        targets.push_back({i, i + 1});
    const auto order = interleave(targets, kWidth);
    ASSERT_EQ(order.size(), targets.size());
    std::set<uint32_t> seen;
    size_t topInFirstHalf = 0;
    for (size_t i = 0; i < order.size(); ++i) {
        EXPECT_EQ(order[i].samples, order[i].pixel + 1);
        seen.insert(order[i].pixel);
        if (i < order.size() / 2 && order[i].pixel / kWidth < kHeight / 2) ++topInFirstHalf;
    }
    EXPECT_EQ(seen.size(), targets.size());
    // A thread that takes the first half of the list gets its fair share of the upper half.
    EXPECT_NEAR(double(topInFirstHalf), double(order.size()) / 4, double(order.size()) / 40);
}

TEST(WorkOrder, KeepsTilesTogether) {
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < 64 * 64; ++i)
        targets.push_back({i, 1});
    const auto order = interleave(targets, 64);
    for (size_t group = 0; group < order.size(); group += 64) {
        const uint32_t tileX = order[group].pixel % 64 / 8, tileY = order[group].pixel / 64 / 8;
        for (size_t i = group; i < group + 64; ++i) {
            EXPECT_EQ(order[i].pixel % 64 / 8, tileX);
            EXPECT_EQ(order[i].pixel / 64 / 8, tileY);
        }
    }
}

TEST(DispatchPace, ApproachesTheTargetTime) {
    DispatchPace pace(0.1, 5000);
    for (int i = 0; i < 20; ++i)
        pace.took(pace.iterations() * 1e-4); // 0.1 ms an iteration
    EXPECT_NEAR(pace.iterations(), 1000, 1);
    for (int i = 0; i < 20; ++i)
        pace.took(1e-9);
    EXPECT_EQ(pace.iterations(), 5000u);
    for (int i = 0; i < 40; ++i)
        pace.took(100);
    EXPECT_EQ(pace.iterations(), 16u);
}

/// Probability of each index that a table gives.
std::vector<double> probabilities(const std::vector<AliasColumn>& table) {
    std::vector<double> p(table.size(), 0.0);
    for (size_t i = 0; i < table.size(); ++i) {
        p[i] += table[i].threshold / double(table.size());
        p[table[i].alias] += (1 - table[i].threshold) / double(table.size());
    }
    return p;
}

TEST(AliasTable, GivesTheWeights) {
    std::mt19937 random(1);
    for (size_t n : {1u, 2u, 3u, 10u, 1000u}) {
        std::vector<double> weights(n);
        for (double& w : weights)
            w = std::exponential_distribution<>(1)(random);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        const std::vector<double> p = probabilities(buildAliasTable(weights));
        for (size_t i = 0; i < n; ++i)
            EXPECT_NEAR(p[i], weights[i] / sum, 1e-12);
    }
}

TEST(AliasTable, NeverPicksAWeightOfZero) {
    for (const std::vector<double>& weights :
         {std::vector<double>{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {0, 0, 1}, {0.1, 0, 0.1, 0, 0.1}}) {
        const std::vector<AliasColumn> table = buildAliasTable(weights);
        for (size_t i = 0; i < weights.size(); ++i) {
            EXPECT_TRUE(weights[i] > 0 || table[i].threshold == 0);
            EXPECT_TRUE(table[i].threshold == 1 || weights[table[i].alias] > 0);
        }
    }
}

Scene oneTriangle(const Material& material) {
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles.push_back({{0, 1, 2}});
    scene.materials = {material};
    scene.instances = {"triangle"};
    return scene;
}

KernelFeatures featuresOf(const Scene& scene, const RenderSettings& settings = {}) {
    const GpuScene gpu = packScene(scene, buildBinaryTree(primitiveBounds(scene)), false);
    return kernelFeatures(gpu, Camera{}, settings, {});
}

TEST(KernelFeatures, HoldOnlyWhatTheSceneNeeds) {
    Scene scene = oneTriangle({});
    KernelFeatures f = featuresOf(scene);
    EXPECT_TRUE(f[SPEC_HAS_TRIANGLES]);
    EXPECT_FALSE(f[SPEC_HAS_SPHERES]);
    EXPECT_FALSE(f[SPEC_HAS_NORMALS]);
    EXPECT_FALSE(f[SPEC_HAS_EMISSION]);
    EXPECT_EQ(f[SPEC_MATERIAL_KINDS], 1u << gpu::MATERIAL_DIFFUSE);
    EXPECT_EQ(f[SPEC_LIGHT_KINDS], 0u);

    Material unused;
    unused.kind = MaterialKind::Glass;
    scene.materials.push_back(unused); // no surface has it
    EXPECT_EQ(featuresOf(scene)[SPEC_MATERIAL_KINDS], 1u << gpu::MATERIAL_DIFFUSE);

    scene.spheres.push_back({{0, 0, 5}, 1, 1, 0});
    f = featuresOf(scene);
    EXPECT_TRUE(f[SPEC_HAS_SPHERES]);
    EXPECT_EQ(f[SPEC_MATERIAL_KINDS], (1u << gpu::MATERIAL_DIFFUSE) | (1u << gpu::MATERIAL_GLASS));
}

TEST(KernelFeatures, LightsFollowTheSettings) {
    Material lamp;
    lamp.emission = glm::vec3(1);
    Scene scene = oneTriangle(lamp);
    Light point;
    scene.lights.push_back(point);
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_KINDS],
              (1u << gpu::LIGHT_MESH) | (1u << gpu::LIGHT_POINT));
    RenderSettings s;
    s.directLight = DirectLight::Bsdf;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_KINDS], 1u << gpu::LIGHT_POINT);
    s.integrator = Integrator::Normals;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_KINDS], 0u);
}

TEST(KernelFeatures, NoRouletteWherePathsEndBeforeIt) {
    RenderSettings s;
    s.maxBounces = 2;
    EXPECT_EQ(featuresOf(oneTriangle({}), s)[SPEC_ROULETTE], gpu::ROULETTE_NONE);
    s.maxBounces = 3;
    EXPECT_EQ(featuresOf(oneTriangle({}), s)[SPEC_ROULETTE], gpu::ROULETTE_THROUGHPUT);
}

} // namespace
} // namespace stromboli
