// What of the scene and the settings a kernel contains, and how primitives are packed.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

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
