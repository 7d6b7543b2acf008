// The host's side of the kernel: work order, pace of dispatches, alias tables, features.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/alias_table.hpp"
#include "host/kernel/dispatch_pace.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/work_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace stromboli {
namespace {

/// Of every n-th pixel, as an adaptive pass leaves them; the sample number names the pixel.
std::vector<PixelTarget> everyNth(uint32_t n, uint32_t pixels) {
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < pixels; i += n)
        targets.push_back({i, i + 1});
    return targets;
}

uint32_t tileOf(const PixelTarget& t, uint32_t width) {
    return t.pixel / width / 8 * 1000 + t.pixel % width / 8;
}

TEST(WorkOrder, TakesTileAfterTileInReadingOrder) {
    for (const uint32_t width : {64u, 61u, 1u, 300u})
        for (const uint32_t n : {1u, 7u}) {
            const auto order = tileOrder(everyNth(n, width * 37), width);
            for (size_t i = 1; i < order.size(); ++i) {
                const uint32_t before = tileOf(order[i - 1], width), now = tileOf(order[i], width);
                ASSERT_LE(before, now) << width << ' ' << i;
                // Row by row within a tile: eight side by side are a row.
                ASSERT_TRUE(before < now || order[i - 1].pixel < order[i].pixel) << i;
            }
        }
}

TEST(WorkOrder, KeepsEveryTarget) {
    const auto targets = everyNth(3, 100 * 60);
    auto order = tileOrder(targets, 100);
    std::ranges::sort(order, {}, &PixelTarget::pixel);
    ASSERT_EQ(order.size(), targets.size());
    for (size_t i = 0; i < order.size(); ++i) {
        EXPECT_EQ(order[i].pixel, targets[i].pixel);
        EXPECT_EQ(order[i].samples, targets[i].samples);
    }
    EXPECT_TRUE(tileOrder({}, 100).empty());
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

KernelFeatures featuresOf(const Scene& scene, const RenderSettings& settings = {},
                          const DeviceTuning& tuning = {}) {
    return kernelFeatures(packScene(scene, buildWideBvh(scene), false), Camera{},
                          settings.estimator, tuning);
}

/// A flat triangle brings its normal, a smooth one those of its corners, also where its material is
/// replaced by a copy that names the lamp it stands for (beside rough metals, which weigh bounces
/// against its samples).
TEST(PackedPrimitives, HaveTheirNormalsWhateverTheirMaterialNames) {
    Material metal, lamp;
    metal.kind = MaterialKind::Microfacet;
    lamp.emission = glm::vec3(1);
    Scene scene = oneTriangle(metal);
    scene.materials.push_back(lamp);
    scene.positions.insert(scene.positions.end(), {{0, 0, 4}, {4, 0, 4}, {0, 4, 7}});
    const glm::vec3 smooth = glm::normalize(glm::vec3(1, 2, 3));
    scene.normals = {smooth};
    scene.triangles.push_back({{3, 4, 5}, {0, 0, 0}, 1});
    const GpuScene packed = packScene(scene, buildWideBvh(scene), false);
    EXPECT_TRUE(packed.hasNormals);
    for (size_t i = 0; i < 2; ++i) {
        const gpu::Primitive& p = packed.primitives[i];
        const bool isLamp = packed.bvh.primitiveOrder[i] == 1;
        const gpu::Material& m = packed.materials.at(materialOf(p));
        EXPECT_EQ(m.light, isLamp ? 0 : gpu::NO_LIGHT);
        EXPECT_EQ((p.material & gpu::PRIMITIVE_IS_SMOOTH) != 0, isLamp);
        if (isLamp)
            EXPECT_LT(glm::distance(decodeNormal(p.n2), smooth), 1e-4f);
        else
            EXPECT_EQ(glm::uintBitsToFloat(glm::uvec3(p.n0, p.n1, p.n2)), glm::vec3(0, 0, 1));
    }
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
    s.estimator.directLight = DirectLight::Bsdf;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_KINDS], 1u << gpu::LIGHT_POINT);
    s.estimator.integrator = Integrator::Normals;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_KINDS], 0u);
}

TEST(KernelFeatures, MisOnlyWhereRoughMetalsMeetLampsThatBouncesFind) {
    Material metal, lamp;
    metal.kind = MaterialKind::Microfacet;
    lamp.emission = glm::vec3(1);
    Scene scene = oneTriangle(metal);
    EXPECT_FALSE(featuresOf(scene)[SPEC_USE_MIS]); // no light
    scene.lights.emplace_back();                   // a point
    EXPECT_FALSE(featuresOf(scene)[SPEC_USE_MIS]);
    scene.materials.push_back(lamp);
    scene.spheres.push_back({{0, 0, 5}, 1, 1, 0});
    EXPECT_TRUE(featuresOf(scene)[SPEC_USE_MIS]);
    for (const DirectLight mode :
         {DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf}) {
        RenderSettings s;
        s.estimator.directLight = mode;
        EXPECT_FALSE(featuresOf(scene, s)[SPEC_USE_MIS]);
    }
    scene.materials[0].kind = MaterialKind::Diffuse;
    EXPECT_FALSE(featuresOf(scene)[SPEC_USE_MIS]);
}

/// A light sample may use the numbers drawn with the path ray, but no two of a surface the same.
TEST(KernelFeatures, LightSamplesShareNumbersOnlyWhereThereIsOne) {
    Material lamp;
    lamp.emission = glm::vec3(1);
    Scene scene = oneTriangle({});
    scene.materials.push_back(lamp);
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_SHARED);
    scene.spheres.push_back({{0, 0, 5}, 1, 1, 0});
    scene.lights.emplace_back(); // a point: takes no numbers
    RenderSettings s;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_SHARED);
    s.estimator.lightSamples = 2;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_FIRST);
    s.estimator.lightSamples = 1;
    s.estimator.cs184 = true; // hemisphere samples for point lights too
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_FIRST);
    scene.spheres.push_back({{0, 0, 9}, 1, 1, 0});
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_FIRST);
    scene.triangles[0].material = 1; // a mesh takes four numbers a sample
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_OWN);
}

TEST(KernelFeatures, NoRouletteWherePathsEndBeforeIt) {
    RenderSettings s;
    s.estimator.maxBounces = 2;
    EXPECT_EQ(featuresOf(oneTriangle({}), s)[SPEC_ROULETTE], gpu::ROULETTE_NONE);
    s.estimator.maxBounces = 3;
    EXPECT_EQ(featuresOf(oneTriangle({}), s)[SPEC_ROULETTE], gpu::ROULETTE_THROUGHPUT);
}

TEST(KernelFeatures, PathsSplitOnlyIfAskedTo) {
    RenderSettings s;
    EXPECT_FALSE(featuresOf(oneTriangle({}), s)[SPEC_SPLITS]);
    s.estimator.branches = 2;
    EXPECT_TRUE(featuresOf(oneTriangle({}), s)[SPEC_SPLITS]);
}

TEST(KernelFeatures, FollowTheTuning) {
    DeviceTuning tuning;
    tuning.workgroupSize = 24, tuning.traversalSteps = 5, tuning.countSteps = true;
    const KernelFeatures f = featuresOf(oneTriangle({}), {}, tuning);
    EXPECT_EQ(f[SPEC_WORKGROUP_SIZE], 24u);
    EXPECT_EQ(f[SPEC_TRAVERSAL_STEPS], 5u);
    EXPECT_EQ(f[SPEC_COUNT_STEPS], 1u);
    EXPECT_GE(f[SPEC_STACK_SIZE], 1u);
}

/// The benchmark's kernel: all that scenes may hold, but of the settings only what is asked for.
TEST(KernelFeatures, EverythingOn) {
    DeviceTuning tuning;
    tuning.everythingOn = true;
    RenderSettings s;
    s.estimator.roulette.mode = Roulette::Mode::None;
    const KernelFeatures f = featuresOf(oneTriangle({}), s, tuning);
    EXPECT_TRUE(f[SPEC_USE_MIS]);
    s.estimator.directLight = DirectLight::Lights;
    EXPECT_FALSE(featuresOf(oneTriangle({}), s, tuning)[SPEC_USE_MIS]);
    for (const uint32_t feature :
         {SPEC_HAS_TRIANGLES, SPEC_HAS_SPHERES, SPEC_HAS_NORMALS, SPEC_HAS_EMISSION})
        EXPECT_EQ(f[feature], 1u) << feature;
    EXPECT_EQ(f[SPEC_MATERIAL_KINDS], 31u);
    EXPECT_EQ(f[SPEC_LIGHT_KINDS], 127u);
    EXPECT_EQ(f[SPEC_ROULETTE], gpu::ROULETTE_NONE);
    EXPECT_EQ(f[SPEC_CS184], 0u);
    EXPECT_EQ(f[SPEC_COUNT_STEPS], 0u);
}

} // namespace
} // namespace stromboli
