// What of lights, and of the rules by which they are found, a kernel contains.
#include "host/cs184/cs184.hpp"
#include "tests/kernel/scene_features.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

namespace stromboli {
namespace {

using namespace test;

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
    EXPECT_TRUE(featuresOf(scene)[SPEC_LIGHT_TREES_BRANCH]);
}

/// A lamp and the sun are two groups of one light each.
TEST(KernelFeatures, GroupsOfOneLightAreNotWalkedDown) {
    Material emitter;
    emitter.emission = glm::vec3(1);
    Scene scene = oneTriangle({});
    scene.materials.push_back(emitter);
    scene.spheres.push_back({{0, 0, 5}, 1, 1, 0});
    scene.lights.push_back({.kind = LightKind::Directional});
    RenderSettings s;
    s.estimator.lightChoice = LightChoice::Tree;
    const auto features = featuresOf(scene, s);
    EXPECT_EQ(features[SPEC_LIGHT_CHOICE], gpu::LIGHT_CHOICE_TREE);
    EXPECT_EQ(features[SPEC_LIGHT_GROUPS],
              1u << gpu::LIGHT_GROUP_NEAR | 1u << gpu::LIGHT_GROUP_INFINITE);
    EXPECT_FALSE(features[SPEC_LIGHT_TREES_BRANCH]);
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

} // namespace
} // namespace stromboli
