// Paths that share a camera ray (docs/theory/estimator.md, "Branches") bring the light that paths
// of their own bring, whatever the number of branches.
#include "tests/analytic/scenes.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

/// Closed, with a corner to look into. Emission is 1 and one minus albedo everywhere, so that all
/// light that is scattered up to N times is the sum of albedo^k.
Scene furnace(const Material& material) {
    SceneMaker maker;
    maker.box({-1, -1, -1}, {1, 1, 1}, maker.add(material), true);
    return maker.scene;
}

RenderSettings branching(uint32_t branches, uint32_t maxBounces) {
    RenderSettings s = smallPicture(36 / branches, maxBounces);
    s.estimator.branches = branches;
    return s;
}

class Branches : public testing::TestWithParam<uint32_t> {};

TEST_P(Branches, FurnaceOfAnyDirectLight) {
    for (const DirectLight mode :
         {DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf}) {
        RenderSettings s = branching(GetParam(), 20);
        s.estimator.directLight = mode;
        expectMean(estimate(furnace(diffuse(0.5f, 1)), kInside, s),
                   glm::dvec3(2 - std::pow(0.5, 20)));
    }
}

TEST_P(Branches, PartialSums) {
    for (const uint32_t n : {0u, 1u, 2u, 5u})
        expectMean(estimate(furnace(diffuse(0.5f, 1)), kInside, branching(GetParam(), n)),
                   glm::dvec3(2 - std::pow(0.5, n)));
}

TEST_P(Branches, FixedRoulette) {
    RenderSettings s = branching(GetParam(), 100);
    s.estimator.roulette = {Roulette::Mode::Fixed, 0.2};
    expectMean(estimate(furnace(diffuse(0.5f, 1)), kInside, s), glm::dvec3(2));
}

TEST_P(Branches, RouletteByThroughput) {
    RenderSettings s = branching(GetParam(), 50);
    s.estimator.roulette.mode = Roulette::Mode::Throughput;
    expectMean(estimate(furnace(diffuse(0.5f, 1)), kInside, s), glm::dvec3(2));
}

/// A mirror first, glass first, metal first: what splits, and where, is a matter of the material.
TEST_P(Branches, BehindEveryMaterial) {
    for (const MaterialKind kind : {MaterialKind::Mirror, MaterialKind::Refraction,
                                    MaterialKind::Dielectric, MaterialKind::Conductor}) {
        SCOPED_TRACE(int(kind));
        SceneMaker maker;
        maker.box({-1, -1, -1}, {1, 1, 1}, maker.add(diffuse(0.5f)), true);
        maker.quad({-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, maker.add(emissive(5)));
        Material m = diffuse(0.5f);
        m.kind = kind;
        m.reflectance = m.transmittance = glm::vec3(0.9f);
        m.ior = 1.5f;
        if (kind == MaterialKind::Conductor)
            m.facets = {FacetDistribution::Beckmann, glm::vec2(0.3f)};
        m.eta = glm::vec3(1.5f), m.k = glm::vec3(3);
        maker.sphere({0.5f, -0.3f, 0}, 0.4f, maker.add(m));
        RenderSettings s = branching(GetParam(), 6);
        s.budget.mostSamplesPerPixel *= 2;
        RenderSettings unsplit = branching(1, 6);
        unsplit.budget.mostSamplesPerPixel *= 2;
        unsplit.estimator.seed = 1;
        expectSameMean(estimate(maker.scene, kInside, s), estimate(maker.scene, kInside, unsplit));
    }
}

TEST_P(Branches, LightOfOneBounceAlone) {
    RenderSettings s = branching(GetParam(), 3);
    s.estimator.minBounce = 3;
    expectMean(estimate(furnace(diffuse(0.5f, 1)), kInside, s), glm::dvec3(0.125));
}

INSTANTIATE_TEST_SUITE_P(Numbers, Branches, testing::Values(1, 2, 3, 4, 9), test::NamedByValue{});

} // namespace
} // namespace stromboli
