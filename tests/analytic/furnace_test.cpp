// Closed surfaces of emission 1 and albedo a: light scattered k times has radiance a^k everywhere,
// so a path limited to N scatterings sees (1 - a^(N + 1)) / (1 - a).
#include "tests/analytic/scenes.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

double partialSum(double a, uint32_t from, uint32_t to) {
    double sum = 0;
    for (uint32_t k = from; k <= to; ++k)
        sum += std::pow(a, k);
    return sum;
}

Scene sphereFurnace(float albedo) {
    SceneMaker b;
    b.sphere({0, 0, 0}, 1, b.add(diffuse(albedo, 1)));
    return b.scene;
}

Scene boxFurnace(const Material& material) {
    SceneMaker b;
    b.box({-1, -1, -1}, {1, 1, 1}, b.add(material), true);
    return b.scene;
}

struct Case {
    DirectLight directLight;
    Roulette::Mode roulette;
};

class Furnace : public testing::TestWithParam<Case> {
  protected:
    RenderSettings settings(uint32_t samples, uint32_t maxBounces) {
        RenderSettings s = smallPicture(samples, maxBounces);
        s.estimator.directLight = GetParam().directLight;
        s.estimator.roulette.mode = GetParam().roulette;
        s.estimator.roulette.terminationProbability = 0.2;
        return s;
    }
};

TEST_P(Furnace, SphereOfManyBounces) {
    const double a = 0.75; // a float, too
    expectMean(estimate(sphereFurnace(0.75f), kInside, settings(16, 100)), 1 / (1 - a));
}

TEST_P(Furnace, SphereOfFewBounces) {
    for (uint32_t n : {0u, 1u, 2u, 5u})
        expectMean(estimate(sphereFurnace(0.5f), kInside, settings(16, n)), partialSum(0.5, 0, n));
}

TEST_P(Furnace, MinBounceLeavesOutWhatScatteredLess) {
    for (uint32_t k : {1u, 2u, 4u}) {
        RenderSettings s = settings(16, 5);
        s.estimator.minBounce = k;
        expectMean(estimate(sphereFurnace(0.5f), kInside, s), partialSum(0.5, k, 5));
    }
}

TEST_P(Furnace, SeveralLightSamplesAreAveraged) {
    RenderSettings s = settings(16, 3);
    s.estimator.lightSamples = 3;
    expectMean(estimate(sphereFurnace(0.5f), kInside, s), partialSum(0.5, 0, 3));
}

TEST_P(Furnace, MirrorBox) {
    Material mirror = diffuse(0, 1);
    mirror.kind = MaterialKind::Mirror;
    mirror.reflectance = glm::vec3(0.5f);
    expectMean(estimate(boxFurnace(mirror), kInside, settings(32, 40)), 2.0);
}

std::string nameOfCase(const testing::TestParamInfo<Case>& one) {
    const char* const roulette = one.param.roulette == Roulette::Mode::None         ? "none"
                                 : one.param.roulette == Roulette::Mode::Throughput ? "throughput"
                                                                                    : "fixed";
    return test::testName(nameOf(one.param.directLight)) + "_roulette_" + roulette;
}

INSTANTIATE_TEST_SUITE_P(AllModes, Furnace,
                         testing::Values(Case{DirectLight::Mis, Roulette::Mode::None},
                                         Case{DirectLight::Mis, Roulette::Mode::Throughput},
                                         Case{DirectLight::Mis, Roulette::Mode::Fixed},
                                         Case{DirectLight::Hemisphere, Roulette::Mode::None},
                                         Case{DirectLight::Hemisphere, Roulette::Mode::Throughput},
                                         Case{DirectLight::Hemisphere, Roulette::Mode::Fixed},
                                         Case{DirectLight::Bsdf, Roulette::Mode::None},
                                         Case{DirectLight::Bsdf, Roulette::Mode::Throughput},
                                         Case{DirectLight::Bsdf, Roulette::Mode::Fixed}),
                         nameOfCase);

/// Not in lights mode: 1 / distance^2 has no variance at the edges of the box, so no bound holds.
TEST(BoxFurnace, HemisphereAndBsdfModes) {
    for (DirectLight directLight : {DirectLight::Hemisphere, DirectLight::Bsdf}) {
        RenderSettings s = smallPicture(32, 40);
        s.estimator.directLight = directLight;
        s.estimator.roulette.mode = Roulette::Mode::Throughput;
        expectMean(estimate(boxFurnace(diffuse(0.5f, 1)), kInside, s), 2.0);
    }
}

} // namespace
} // namespace stromboli
