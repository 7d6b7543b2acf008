// Rough metals under lights of every kind: light samples alone, bounces alone and both, weighted,
// find the same light. The reference combines nothing, so that there two independent estimators are
// left, where facets are wide.
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace stromboli {
namespace {

using namespace test;

const Camera kLow = pointCamera({3, 1.5, 3}, {0, 0, 0});

/// A light that a floor at y = 0 reflects towards kLow.
struct LightCase {
    const char* name;
    std::function<void(SceneMaker&)> add;
    uint32_t lightSamples = 1;
};

void addQuad(SceneMaker& maker, bool bothSides) {
    maker.quad({-3, 1, -3}, {1.5f, 0, -0.5f}, {0, 1, 0}, maker.add(emissive(2, bothSides)));
}

/// Many triangles in the plane of addQuad's, or few of unequal size.
void addMesh(SceneMaker& maker, int columns) {
    const uint32_t material = maker.add(emissive(2));
    maker.startInstance();
    for (int i = 0; i < columns; ++i) {
        const auto at = [&](int k, float height) {
            const float x = float(k * k) / float(columns * columns);
            return glm::vec3(-3 + 1.5f * x, height, -3 - 0.5f * x);
        };
        maker.triangle(at(i, 1), at(i + 1, 1), at(i + 1, 2), material);
        maker.triangle(at(i, 1), at(i + 1, 2), at(i, 2.5f), material);
    }
}

void addAmbient(SceneMaker& maker, bool upperHemisphereOnly) {
    Light light = ambient(1);
    light.upperHemisphereOnly = upperHemisphereOnly;
    maker.add(light);
}

/// A dim sky with a sun of 3 degrees that lies where kLow sees its reflection.
void addEnvironment(SceneMaker& maker) {
    Environment e;
    e.width = 128;
    e.height = 64;
    for (uint32_t y = 0; y < e.height; ++y)
        for (uint32_t x = 0; x < e.width; ++x)
            e.radiance.resize(e.radiance.size() + 1, glm::vec3(y < 32 ? 0.5f : 0.1f));
    e.radiance.erase(e.radiance.begin());
    e.radiance[25 * 128 + 80] = glm::vec3(200);
    maker.scene.environment = e;
}

/// The scene has a gap that bounces are sent into (docs/theory/estimator.md, "Gaps").
void addQuadBeforeAWall(SceneMaker& maker) {
    maker.quad({-1, 2, -1}, {0, 0, 2}, {2, 0, 0}, maker.add(emissive(2)));
    maker.quad({-3, 2.02f, -3}, {6, 0, 0}, {0, 0, 6}, maker.add(diffuse(0.8f)));
}

const LightCase kLightCases[] = {
    {"quad", [](SceneMaker& m) { addQuad(m, true); }},
    {"one_sided_quad", [](SceneMaker& m) { addQuad(m, false); }},
    {"quad_of_four_samples", [](SceneMaker& m) { addQuad(m, true); }, 4},
    {"mesh", [](SceneMaker& m) { addMesh(m, 3); }},
    {"quad_before_a_wall", addQuadBeforeAWall},
    {"quad_before_a_wall_under_a_sky",
     [](SceneMaker& m) {
         addQuadBeforeAWall(m);
         addAmbient(m, false);
     }},
    {"many_triangles", [](SceneMaker& m) { addMesh(m, 40); }},
    {"many_triangles_and_a_sphere",
     [](SceneMaker& m) {
         addMesh(m, 40);
         m.sphere({-2, 0.75f, -1}, 0.5f, m.add(emissive(3)));
     }},
    {"sphere",
     [](SceneMaker& m) {
         m.sphere({-2, 1.5f, -2}, 0.75f, m.add(emissive(2)));
     }},
    {"in_a_sphere",
     [](SceneMaker& m) {
         m.sphere({1, 2, -1}, 8, m.add(emissive(2)));
     }},
    {"ambient", [](SceneMaker& m) { addAmbient(m, false); }},
    {"upper_ambient", [](SceneMaker& m) { addAmbient(m, true); }},
    {"environment", [](SceneMaker& m) { addEnvironment(m); }},
    {"environment_and_a_quad",
     [](SceneMaker& m) {
         addEnvironment(m);
         addQuad(m, true);
     }},
    {"all", [](SceneMaker& m) {
         addQuad(m, true);
         m.sphere({-1, 0.75f, -2}, 0.5f, m.add(emissive(3)));
         addAmbient(m, false);
     }}};

class Mis : public testing::TestWithParam<LightCase> {
  protected:
    Estimate render(double alpha, DirectLight mode, uint32_t seed) {
        return render(metal(float(alpha)), mode, seed);
    }
    Estimate render(const Material& floor, DirectLight mode, uint32_t seed) {
        SceneMaker maker;
        addFloor(maker, maker.add(floor));
        GetParam().add(maker);
        RenderSettings s = smallPicture(400, 3);
        s.estimator.directLight = mode;
        s.estimator.lightSamples = GetParam().lightSamples;
        s.estimator.seed = seed;
        return estimate(maker.scene, kLow, s);
    }
};

TEST_P(Mis, FindsTheLightThatEitherFinds) {
    for (const double alpha : {0.03, 0.2, 0.8}) {
        // The reference leaves the light of narrow lobes to bounces, in each mode.
        if (alpha < 0.25 && !kCombinesLightSamplesWithBounces) continue;
        SCOPED_TRACE(alpha);
        const Estimate both = render(alpha, DirectLight::Mis, 1);
        EXPECT_GT(both.mean.x, 0);
        expectSameMean(both, render(alpha, DirectLight::Bsdf, 2));
        // A narrow lobe's light samples are so rarely in it that their error is not known.
        if (alpha > 0.1 && isAnotherWay(DirectLight::Lights))
            expectSameMean(both, render(alpha, DirectLight::Lights, 3));
    }
}

/// Diffuse surfaces share all lights, the sky alone, or none.
TEST_P(Mis, DiffuseSurfacesToo) {
    const Material floor = diffuse(0.5f);
    const Estimate both = render(floor, DirectLight::Mis, 5);
    EXPECT_GT(both.mean.x, 0);
    for (const DirectLight mode : {DirectLight::Lights, DirectLight::MisAll, DirectLight::Bsdf})
        if (isAnotherWay(mode)) expectSameMean(render(floor, mode, 6 + uint32_t(mode)), both);
}

INSTANTIATE_TEST_SUITE_P(Lights, Mis, testing::ValuesIn(kLightCases),
                         [](const auto& light) { return light.param.name; });

} // namespace
} // namespace stromboli
