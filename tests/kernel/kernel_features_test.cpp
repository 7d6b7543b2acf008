// What of the scene and the settings a kernel contains.
#include "host/kernel/dispatcher.hpp"
#include "shaders/shared/guide_types.h"
#include "shaders/shared/texture_types.h"
#include "tests/kernel/scene_features.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace stromboli {
namespace {

using namespace test;

TEST(KernelFeatures, HoldOnlyWhatTheSceneNeeds) {
    Scene scene = oneTriangle({});
    KernelFeatures f = featuresOf(scene);
    EXPECT_TRUE(f[SPEC_HAS_TRIANGLES]);
    EXPECT_FALSE(f[SPEC_HAS_SPHERES]);
    EXPECT_FALSE(f[SPEC_HAS_NORMALS]);
    EXPECT_FALSE(f[SPEC_HAS_EMISSION]);
    constexpr uint32_t kDiffuse =
        gpu::CLOSURE_BASE | gpu::LOBE_DIFFUSE_REFLECTION | gpu::HAS_BASE_COLOR;
    EXPECT_EQ(f[SPEC_CLOSURES], kDiffuse);
    EXPECT_EQ(f[SPEC_CLOSURES_OF_ALL], kDiffuse);
    EXPECT_EQ(f[SPEC_LIGHT_KINDS], 0u);

    Material unused;
    unused.kind = MaterialKind::Dielectric;
    scene.materials.push_back(unused); // no surface has it
    EXPECT_EQ(featuresOf(scene)[SPEC_CLOSURES], kDiffuse);

    scene.spheres.push_back({{0, 0, 5}, 1, 1, 0});
    f = featuresOf(scene);
    EXPECT_TRUE(f[SPEC_HAS_SPHERES]);
    EXPECT_EQ(f[SPEC_CLOSURES], kDiffuse | closureBits(unused));
    EXPECT_EQ(f[SPEC_CLOSURES_OF_ALL], gpu::INTERFACE_IS_SMOOTH | gpu::INTERFACE_IS_DIELECTRIC);
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

/// Textures that change nothing, and alpha modes of what is opaque everywhere, cost nothing.
TEST(KernelFeatures, TexturesAndOpacityOnlyWhereTheyHaveAnEffect) {
    Scene scene = oneTriangle({});
    scene.images.resize(1);
    scene.images[0].width = scene.images[0].height = 1;
    scene.images[0].words = {0xFF804020};
    scene.textures.resize(1);
    scene.attributes.resize(3);
    scene.attributeCorners = {{0, 1, 2}};
    Material& m = scene.materials[0];
    m.alphaMode = AlphaMode::Mask;
    for (const TextureSlot slot : {TextureSlot::Emission, TextureSlot::MetallicRoughness,
                                   TextureSlot::ClearcoatNormal, TextureSlot::SheenColor})
        m.textures.push_back({.slot = slot});
    KernelFeatures f = featuresOf(scene);
    for (const uint32_t id :
         {SPEC_TEXTURE_SLOTS, SPEC_LOOSE_SLOTS, SPEC_TEXEL_KINDS, SPEC_ATTRIBUTES, SPEC_HAS_ALPHA})
        EXPECT_EQ(f[id], 0u) << id;
    EXPECT_TRUE(packScene(scene, buildWideBvh(scene)).details.rows.empty());

    m.textures.push_back({.slot = TextureSlot::BaseColor});
    f = featuresOf(scene);
    EXPECT_EQ(f[SPEC_TEXTURE_SLOTS], 1u << gpu::TEXTURE_BASE_COLOR);
    EXPECT_EQ(f[SPEC_TEXEL_KINDS], gpu::TEXEL_KIND_BILINEAR | gpu::TEXEL_KIND_BYTES |
                                       gpu::TEXEL_KIND_LOOSE | gpu::TEXEL_KIND_REPEAT |
                                       gpu::TEXEL_KIND_GATHERED);
    EXPECT_EQ(f[SPEC_LOOSE_SLOTS], 1u << gpu::TEXTURE_BASE_COLOR);
    EXPECT_EQ(f[SPEC_ATTRIBUTES], gpu::ATTRIBUTE_UV0);
    EXPECT_EQ(f[SPEC_HAS_ALPHA], 0u);
    EXPECT_EQ(packScene(scene, buildWideBvh(scene)).details.rows.size(), 8u)
        << "two rows of coordinates, and the texel at three columns and two lines";

    scene.images[0].words = {0x7F804020};
    EXPECT_EQ(featuresOf(scene)[SPEC_HAS_ALPHA], 1u);
    scene.images[0].words = {0xFF804020};
    scene.attributes[1].color.a = 0.5f;
    f = featuresOf(scene);
    EXPECT_EQ(f[SPEC_HAS_ALPHA], 1u);
    EXPECT_EQ(f[SPEC_ATTRIBUTES], gpu::ATTRIBUTE_UV0 | gpu::ATTRIBUTE_COLOR);
    m.textures.push_back({.slot = TextureSlot::Normal, .uvSet = 1});
    f = featuresOf(scene);
    EXPECT_EQ(f[SPEC_ATTRIBUTES], gpu::ATTRIBUTE_UV0 | gpu::ATTRIBUTE_UV1 | gpu::ATTRIBUTE_COLOR |
                                      gpu::ATTRIBUTE_TANGENT);
    EXPECT_EQ(f[SPEC_HAS_NORMALS], 1u) << "a flat surface with a map";
    Material unused = m;
    m = Material{};
    scene.materials.push_back(unused);
    scene.attributes[1].color.a = 1;
    EXPECT_EQ(featuresOf(scene)[SPEC_TEXTURE_SLOTS], 0u) << "no surface has it";
}

/// The service of textured and layered scenes is long, so that lanes wait for more steps of others;
/// and what a dispatch may run is counted by the steps that the kernel takes.
TEST(KernelFeatures, LongServicesTakeMoreSteps) {
    DeviceTuning tuning;
    tuning.traversalSteps = 5;
    tuning.richTraversalSteps = 12;
    const auto steps = [&](PixelFilter filter) {
        Scene scene = oneTriangle({});
        const Camera camera = makeCamera(scene, CameraChoice::Automatic, 4, 4);
        Estimator settings;
        settings.filter = filter;
        return kernelFeatures(packScene(scene, buildWideBvh(scene)), camera, settings, tuning);
    };
    EXPECT_EQ(steps(PixelFilter::Box)[SPEC_TRAVERSAL_STEPS], 5u);
    EXPECT_EQ(steps(PixelFilter::Gaussian)[SPEC_TRAVERSAL_STEPS], 12u);
    EXPECT_EQ(passesOfCameraRays(steps(PixelFilter::Box)), 6u);
    EXPECT_EQ(passesOfCameraRays(steps(PixelFilter::Gaussian)), 13u);
    // Newton's ten steps and their end, for columns and rows.
    EXPECT_EQ(passesOfCameraRays(steps(PixelFilter::BlackmanHarris)), 13u + 22u);
}

/// Rays of large rooms visit more records, and lanes trace as many before they are served; numbers
/// that are asked for, and those of scenes of which nothing is known, stay.
TEST(KernelFeatures, StepsFitTheRaysOfTheScene) {
    DeviceTuning tuning;
    tuning.traversalSteps = 5;
    tuning.richTraversalSteps = 8;
    tuning.stepsFitRays = true;
    const Scene scene = oneTriangle({});
    GpuScene packed = packScene(scene, buildWideBvh(scene));
    const auto steps = [&](double records, PixelFilter filter) {
        packed.ofRay.records = records;
        Estimator settings;
        settings.filter = filter;
        return kernelFeatures(packed, Camera{}, settings, tuning)[SPEC_TRAVERSAL_STEPS];
    };
    for (const auto& [records, plain, rich] : {std::array{0.0, 5.0, 8.0},
                                               {1.0, 4.0, 4.0},
                                               {6.7, 6.0, 10.0},
                                               {8.9, 8.0, 14.0},
                                               {13.6, 14.0, 16.0},
                                               {1e9, 16.0, 16.0}}) {
        EXPECT_EQ(steps(records, PixelFilter::Box), plain) << records;
        EXPECT_EQ(steps(records, PixelFilter::Gaussian), rich) << records;
    }
    tuning.stepsFitRays = false;
    EXPECT_EQ(steps(9, PixelFilter::Box), 5u);
}

/// Only where it is known that rays rarely meet one, and no device leaves out what no lane needs.
TEST(KernelFeatures, SpheresWaitWhereTheyAreFew) {
    DeviceTuning tuning;
    Scene scene = oneTriangle({});
    scene.spheres.push_back({{0, 0, 5}, 1, 0, 0});
    GpuScene packed = packScene(scene, buildWideBvh(scene));
    const auto wait = [&](const VisitsOfRay& visits) {
        packed.ofRay = visits;
        return kernelFeatures(packed, Camera{}, {}, tuning)[SPEC_SPHERES_WAIT] != 0;
    };
    EXPECT_FALSE(wait({}));
    EXPECT_TRUE(wait({8, 0.2}));
    EXPECT_FALSE(wait({8, 1}));
    tuning.stepsBranch = true;
    EXPECT_FALSE(wait({8, 0.2}));
}

/// Maps make shading normals of flat triangles, too, which then have none of their corners.
TEST(KernelFeatures, SayWhereShadingNormalsComeFrom) {
    KernelFeatures f = featuresOf(oneTriangle({}));
    EXPECT_THAT(describe(f), testing::Not(testing::Contains("shading normals")));
    f[SPEC_HAS_NORMALS] = 1;
    EXPECT_THAT(describe(f), testing::Contains("shading normals"));
    EXPECT_THAT(describe(f), testing::Not(testing::Contains("normals of corners")));
    f[SPEC_CORNER_NORMALS] = 1;
    EXPECT_THAT(describe(f), testing::Contains("normals of corners"));
}

/// A line for each that is there, by the kind of its value.
TEST(KernelFeatures, AreDescribedByTheirTable) {
    EXPECT_EQ(featureTable().size() + 1, SPEC_COUNT) << "all but the size of a workgroup";
    KernelFeatures f{};
    f[SPEC_HAS_SPHERES] = 1;
    f[SPEC_STACK_SIZE] = 12;
    f[SPEC_LIGHT_KINDS] = 1u << gpu::LIGHT_QUAD | 1u << gpu::LIGHT_SPOT;
    f[SPEC_PIXEL_FILTER] = gpu::FILTER_TENT;
    f[SPEC_FILTER_EXTRA] = std::bit_cast<uint32_t>(0.25f);
    f[SPEC_TRAVERSAL_LEGS] = 3;
    const auto lines = describe(f);
    EXPECT_THAT(lines,
                testing::IsSupersetOf({"spheres", "traversal stack: 12 entries",
                                       "lights: quad, spot", "pixel filter: tent",
                                       "filter wider by: 25 %", "legs between two services: 3"}));
    EXPECT_THAT(lines, testing::Not(testing::Contains("triangles")));
    EXPECT_THAT(lines, testing::Not(testing::Contains(testing::StartsWith("materials"))));
    for (const Feature& feature : featureTable()) {
        EXPECT_STRNE(feature.adds, "") << feature.name;
        EXPECT_STRNE(feature.label, "") << feature.name;
    }
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

/// What a texture makes less metallic may transmit.
TEST(KernelFeatures, MetalThatATextureMakesClearTransmits) {
    Material m;
    m.kind = MaterialKind::Principled;
    m.principled.metallic = 1;
    m.principled.transmission = 1;
    constexpr uint32_t kThrough = gpu::INTERFACE_REFRACTS | gpu::INTERFACE_IS_THIN;
    EXPECT_EQ(closureBits(m) & kThrough, 0u);
    m.textures = {{.slot = TextureSlot::MetallicRoughness}};
    EXPECT_EQ(closureBits(m) & kThrough, gpu::INTERFACE_IS_THIN);
    m.principled.isThin = false;
    EXPECT_EQ(closureBits(m) & kThrough, gpu::INTERFACE_REFRACTS);
}

/// Devices that end loops after so many passes would else end those of a lane too soon.
TEST(KernelFeatures, AllLoopsCountTowardsTheLimit) {
    const Scene scene = oneTriangle({});
    const GpuScene gpu = packScene(scene, buildWideBvh(scene));
    const KernelFeatures plain = featuresOf(scene);
    const auto passesWith = [&](uint32_t feature, uint32_t value) {
        KernelFeatures f = plain;
        f[feature] = value;
        return loopPasses(gpu, f) - loopPasses(gpu, plain);
    };
    EXPECT_EQ(passesWith(SPEC_FOCI, 4), 2u * (4 + 1)) << "a lamp is drawn, and its density told";
    EXPECT_EQ(passesWith(SPEC_PORTALS, 4), 3u * (4 + 1));
    EXPECT_EQ(passesWith(SPEC_GUIDES_LIGHT, 1), 3u * (gpu::GUIDE_LEVELS + 1));
}

/// The benchmark's kernel: all that scenes may hold, but of the settings only what is asked for.
TEST(KernelFeatures, EverythingOn) {
    DeviceTuning tuning;
    tuning.everythingOn = true;
    RenderSettings s;
    s.estimator.roulette.mode = Roulette::Mode::None;
    const KernelFeatures f = featuresOf(oneTriangle({}), s, tuning);
    EXPECT_TRUE(f[SPEC_MIS_LOBES]);
    s.estimator.directLight = DirectLight::Lights;
    EXPECT_FALSE(featuresOf(oneTriangle({}), s, tuning)[SPEC_MIS_LOBES]);
    for (const uint32_t feature :
         {SPEC_HAS_TRIANGLES, SPEC_HAS_SPHERES, SPEC_HAS_NORMALS, SPEC_HAS_EMISSION})
        EXPECT_EQ(f[feature], 1u) << feature;
    EXPECT_EQ(f[SPEC_CLOSURES], gpu::CLOSURE_MASK);
    EXPECT_EQ(f[SPEC_CLOSURES_OF_ALL], 0u);
    EXPECT_EQ(f[SPEC_LIGHT_KINDS], (1u << gpu::LIGHT_KIND_COUNT) - 1);
    EXPECT_EQ(f[SPEC_ROULETTE], gpu::ROULETTE_NONE);
    EXPECT_EQ(f[SPEC_DEPARTURES], 0u);
    EXPECT_EQ(f[SPEC_COUNT_STEPS], 0u);
}

} // namespace
} // namespace stromboli
