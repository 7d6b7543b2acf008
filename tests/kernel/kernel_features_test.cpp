// What of the scene and the settings a kernel contains.
#include "host/bvh/wide_layout.hpp"
#include "host/cs184/cs184.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/kernel/light_table.hpp"
#include "shaders/shared/texture_types.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

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
    return kernelFeatures(packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator)),
                          Camera{}, settings.estimator, tuning);
}

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

TEST(KernelFeatures, LightsFollowTheSettings) {
    Material emitter;
    emitter.emission = glm::vec3(1);
    Scene scene = oneTriangle(emitter);
    Light point;
    scene.lights.push_back(point);
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_KINDS],
              (1u << gpu::LIGHT_TRIANGLE) | (1u << gpu::LIGHT_POINT));
    RenderSettings s;
    s.estimator.directLight = DirectLight::Bsdf;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_KINDS], 1u << gpu::LIGHT_POINT);
    s.estimator.integrator = Integrator::Normals;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_KINDS], 0u);
}

/// A kernel that sees has the surfaces of the one that takes samples, and none of its light.
TEST(KernelFeatures, SeeingNeedsNoLight) {
    Material emitter;
    emitter.emission = glm::vec3(1);
    Scene scene = oneTriangle(emitter);
    scene.lights.emplace_back().kind = LightKind::Ambient;
    scene.lights.emplace_back(); // a point
    RenderSettings s;
    s.estimator.branches = 4;
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    const KernelFeatures light = kernelFeatures(gpu, Camera{}, s.estimator, {});
    for (const auto& [what, integrator] : {std::pair{Seeing::Coverage, gpu::INTEGRATOR_COVERAGE},
                                           std::pair{Seeing::Surfaces, gpu::INTEGRATOR_LAYERS}}) {
        const KernelFeatures f = seeingFeatures(gpu, Camera{}, s.estimator, {}, what);
        EXPECT_EQ(f[SPEC_INTEGRATOR], integrator);
        EXPECT_EQ(f[SPEC_CLOSURES], what == Seeing::Surfaces ? light[SPEC_CLOSURES] : 0u);
        for (const uint32_t ofLight :
             {SPEC_LIGHT_KINDS, SPEC_HAS_EMISSION, SPEC_HAS_AMBIENT, SPEC_AMBIENT_BY_BOUNCES,
              SPEC_MIS_LOBES, SPEC_ROULETTE, SPEC_SPLITS}) {
            EXPECT_EQ(f[ofLight], 0u) << ofLight;
            EXPECT_TRUE(light[ofLight] != 0 || ofLight == SPEC_MIS_LOBES) << ofLight;
        }
    }
}

TEST(KernelFeatures, MisOnlyWhereRoughMetalsMeetEmittersThatBouncesFind) {
    Material metal, emitter;
    metal.kind = MaterialKind::Conductor;
    metal.facets = {FacetDistribution::Beckmann, glm::vec2(0.1f)};
    emitter.emission = glm::vec3(1);
    Scene scene = oneTriangle(metal);
    EXPECT_FALSE(featuresOf(scene)[SPEC_MIS_LOBES]); // no light
    scene.lights.emplace_back();                     // a point
    EXPECT_FALSE(featuresOf(scene)[SPEC_MIS_LOBES]);
    scene.materials.push_back(emitter);
    scene.spheres.push_back({{0, 0, 5}, 1, 1, 0});
    EXPECT_TRUE(featuresOf(scene)[SPEC_MIS_LOBES]);
    for (const DirectLight mode :
         {DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf}) {
        RenderSettings s;
        s.estimator.directLight = mode;
        EXPECT_FALSE(featuresOf(scene, s)[SPEC_MIS_LOBES]);
    }
    scene.materials[0].kind = MaterialKind::Diffuse;
    EXPECT_FALSE(featuresOf(scene)[SPEC_MIS_LOBES]);
}

/// Bounces find the sky as well as samples of it do: beside other lights they do it alone, else
/// both share it, from diffuse surfaces too. docs/results.md has the gain.
TEST(KernelFeatures, TheSkyIsFoundByBounces) {
    Scene scene = oneTriangle({});
    scene.lights.emplace_back().kind = LightKind::Ambient;
    const auto featuresIn = [&](DirectLight mode) {
        RenderSettings s;
        s.estimator.directLight = mode;
        return featuresOf(scene, s);
    };
    EXPECT_EQ(featuresIn(DirectLight::Mis)[SPEC_MIS_LOBES], gpu::LOBE_DIFFUSE_REFLECTION);
    EXPECT_FALSE(featuresIn(DirectLight::Mis)[SPEC_AMBIENT_BY_BOUNCES]);
    scene.lights.emplace_back(); // a point
    EXPECT_FALSE(featuresIn(DirectLight::Mis)[SPEC_MIS_LOBES]);
    EXPECT_TRUE(featuresIn(DirectLight::Mis)[SPEC_AMBIENT_BY_BOUNCES]);
    EXPECT_TRUE(featuresIn(DirectLight::Mis)[SPEC_HAS_AMBIENT]);
    EXPECT_EQ(featuresIn(DirectLight::Mis)[SPEC_LIGHT_KINDS], 1u << gpu::LIGHT_POINT)
        << "no code to sample the sky";
    EXPECT_EQ(featuresIn(DirectLight::Mis)[SPEC_LIGHT_CHOICE], gpu::LIGHT_CHOICE_ONE);
    EXPECT_EQ(featuresIn(DirectLight::MisAll)[SPEC_MIS_LOBES], gpu::LOBE_DIFFUSE_REFLECTION);
    for (const DirectLight mode :
         {DirectLight::MisAll, DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf})
        EXPECT_FALSE(featuresIn(mode)[SPEC_AMBIENT_BY_BOUNCES]) << nameOf(mode);
}

/// Lights packed for one way to find direct light are refused where another would count some of
/// them twice or not at all.
TEST(KernelFeatures, LightsPackedForAnotherModeAreRefused) {
    Material emitter;
    emitter.emission = glm::vec3(1);
    Scene lit = oneTriangle(emitter), sunAndSky = oneTriangle({});
    sunAndSky.lights.resize(2);
    sunAndSky.lights[0].kind = LightKind::Ambient;
    const auto sampling = [](const Scene& scene, DirectLight packedFor, DirectLight mode) {
        Estimator packing, e;
        packing.directLight = packedFor;
        e.directLight = mode;
        const GpuScene g = packScene(scene, buildWideBvh(scene), lightSelection(packing));
        return directSampling(g.lights, e);
    };
    using enum DirectLight;
    for (const DirectLight mode : {Hemisphere, Bsdf}) {
        EXPECT_THROW(sampling(lit, Mis, mode), std::invalid_argument) << nameOf(mode);
        EXPECT_EQ(sampling(lit, mode, mode).lights, 0u) << nameOf(mode);
    }
    for (const DirectLight mode : {MisAll, Lights}) {
        EXPECT_THROW(sampling(sunAndSky, Mis, mode), std::invalid_argument) << nameOf(mode);
        EXPECT_EQ(sampling(sunAndSky, mode, mode).lights, 2u) << nameOf(mode);
    }
    EXPECT_EQ(sampling(sunAndSky, Mis, Mis).lights, 1u);
}

/// A light sample may use the numbers drawn with the path ray, but no two of a surface the same.
TEST(KernelFeatures, LightSamplesShareNumbersOnlyWhereThereIsOne) {
    Material emitter;
    emitter.emission = glm::vec3(1);
    Scene scene = oneTriangle({});
    scene.materials.push_back(emitter);
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_SHARED);
    for (int i = 0; i < 3; ++i)
        scene.spheres.push_back({{0, 0, 5 + 4 * float(i)}, 1, 1, 0});
    RenderSettings s;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_SHARED) << "one of all";
    s.estimator.lightSamples = 2;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_FIRST);
    s.estimator.lightSamples = 1;
    s.estimator.lightChoice = LightChoice::Each;
    EXPECT_EQ(featuresOf(scene, s)[SPEC_LIGHT_NUMBERS], gpu::LIGHT_NUMBERS_FIRST);
}

TEST(KernelFeatures, OneLightIsNotChosen) {
    Material emitter;
    emitter.emission = glm::vec3(1);
    Scene scene = oneTriangle({});
    scene.materials.push_back(emitter);
    scene.spheres.push_back({{0, 0, 5}, 1, 1, 0});
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_CHOICE], gpu::LIGHT_CHOICE_ONE);
    for (int i = 0; i < 9; ++i)
        scene.spheres.push_back({{0, 0, 9 + 4 * float(i)}, 1, 1, 0});
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_CHOICE], gpu::LIGHT_CHOICE_TREE);
    EXPECT_EQ(featuresOf(scene)[SPEC_LIGHT_GROUPS], 1u << gpu::LIGHT_GROUP_NEAR);
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

/// Each rule of shading that the kernel follows has a bit of its own, so that any mixture is told
/// apart; those of which lights are packed, and the terminator offset, are no business of it.
TEST(KernelFeatures, EachConventionIsABit) {
    using C = ShadingConventions;
    EXPECT_EQ(departures({}), 0u);
    EXPECT_EQ(departures(cs184Shading()), 0xFFu);
    uint32_t seen = 0;
    for (bool C::*member : {&C::facesForward, &C::testsGeometricSide, &C::exactFresnel,
                            &C::exactLambda, &C::compressesRadiance, &C::bouncesFindAllLight,
                            &C::inverseSquareFalloff, &C::ambientAboutNormal}) {
        C one;
        one.*member = false;
        const uint32_t bit = departures(one);
        EXPECT_TRUE(std::has_single_bit(bit));
        EXPECT_EQ(seen & bit, 0u);
        seen |= bit;
    }
    for (bool C::*member : {&C::offsetsTerminator, &C::samplesEmitters, &C::everyLightInTurn,
                            &C::hemispherePerLight}) {
        C one;
        one.*member = !(one.*member);
        EXPECT_EQ(departures(one), 0u);
    }
}

/// Rules that the kernel does not follow together are refused, not rendered wrong.
TEST(KernelFeatures, RulesOfLightGoTogether) {
    using C = ShadingConventions;
    const auto ofKernel = [](const C& conventions) {
        RenderSettings s;
        s.estimator.conventions = conventions;
        return featuresOf(oneTriangle({}), s)[SPEC_DEPARTURES];
    };
    EXPECT_EQ(ofKernel(cs184Shading()), departures(cs184Shading()));
    for (bool C::*member : {&C::samplesEmitters, &C::inverseSquareFalloff, &C::ambientAboutNormal,
                            &C::hemispherePerLight}) {
        C one;
        one.*member = !(one.*member);
        EXPECT_THROW(ofKernel(one), std::invalid_argument);
    }
    EXPECT_THROW(ofKernel({.bouncesFindAllLight = false, .samplesEmitters = false}),
                 std::invalid_argument);
    EXPECT_THROW(ofKernel({.bouncesFindAllLight = false, .inverseSquareFalloff = false}),
                 std::invalid_argument);
    const C rectangles = {
        .bouncesFindAllLight = false, .samplesEmitters = false, .everyLightInTurn = true};
    EXPECT_EQ(ofKernel(rectangles), departures(rectangles));
}

/// Which lights are packed, by the conventions that say so.
TEST(LightSelection, FollowsTheConventions) {
    Material emitter;
    emitter.emission = glm::vec3(1);
    Scene scene = oneTriangle(emitter);
    scene.lights.resize(4);
    scene.lights[0].kind = scene.lights[1].kind = LightKind::Ambient;
    scene.lights[3].color = glm::vec3(0);
    const auto count = [&](const ShadingConventions& conventions,
                           DirectLight direct = DirectLight::Lights) {
        Estimator e;
        e.conventions = conventions;
        e.directLight = direct;
        return packScene(scene, buildWideBvh(scene), lightSelection(e)).lights.count;
    };
    EXPECT_EQ(count({}), 3u); // the triangle, the sum of ambient light, the point light that shines
    EXPECT_EQ(count({}, DirectLight::Mis), 2u); // the sky is left to bounces
    EXPECT_EQ(count({.samplesEmitters = false}), 2u);
    EXPECT_EQ(count({.everyLightInTurn = true}), 5u);
    EXPECT_EQ(count({}, DirectLight::Hemisphere), 1u);
    EXPECT_EQ(count({.hemispherePerLight = true}, DirectLight::Hemisphere), 3u);
    EXPECT_EQ(count(cs184Shading(), DirectLight::Hemisphere), 4u);
    EXPECT_EQ(count(cs184Shading(), DirectLight::Bsdf), 2u);
}

/// The benchmark's kernel: all that scenes may hold, but of the settings only what is asked for.
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
