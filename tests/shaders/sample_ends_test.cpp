// Samplers at the ends of the interval that random numbers come from, 0 and 1 - 2^-24, in all
// combinations: what comes out is finite and in its domain. Warps of the square and emitters have
// such tests of their own (warps_test.cpp, light_sampling_test.cpp, sphere_light_test.cpp).
#include "host/cs184/cs184.hpp"
#include "host/reference/sampling.hpp"
#include "tests/shaders/bsdf_fixture.hpp"
#include "tests/shaders/light_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace stromboli::test {
namespace {

using reference::kPi;

const float kEnds[] = {0, 0x1p-24f, 0.5f, 1 - 0x1p-24f};

/// One of each kind, microfacets from nearly a mirror to rough.
std::vector<Material> allMaterials() {
    std::vector<Material> materials(7);
    constexpr MaterialKind kSmooth[] = {MaterialKind::Diffuse, MaterialKind::Mirror,
                                        MaterialKind::Refraction, MaterialKind::Dielectric};
    for (size_t i = 0; i < 4; ++i)
        materials[i].kind = kSmooth[i];
    for (Material& m : materials) {
        m.albedo = m.reflectance = m.transmittance = glm::vec3(0.9f);
        m.ior = 1.5f;
        m.eta = {1.3f, 1.0f, 0.7f};
        m.k = {7.3f, 6.6f, 5.6f};
    }
    for (size_t i = 0; i < 3; ++i) {
        constexpr float kAlphas[] = {1e-4f, 0.1f, 1};
        materials[4 + i].kind = MaterialKind::Conductor;
        materials[4 + i].facets = {FacetDistribution::Beckmann, glm::vec2(kAlphas[i])};
    }
    return materials;
}

/// Views from the normal to a millionth of a degree above the plane, and below the shading normal's
/// horizon.
std::vector<glm::vec3> views() {
    std::vector<glm::vec3> views;
    for (const float height : {1.0f, 0.3f, 1e-2f, 1e-4f, 1e-8f, 1e-20f, 1e-38f})
        for (const float x : {1.0f, -1.0f})
            views.push_back(
                glm::normalize(glm::vec3(x * std::sqrt(1 - height * height), 0, height)));
    return views;
}

class BsdfEnds : public BsdfFixture, public ::testing::WithParamInterface<ShadingConventions> {
  protected:
    BsdfEnds() : BsdfFixture(allMaterials(), GetParam()) {}

    /// One scattering gives back no more than it takes, but for the index squared of glass, and for
    /// metals under the conventions whose Lambda is pi / sqrt(pi) of the exact one, and below 0 by
    /// up to 0.05 far from grazing angles.
    double largestWeight(const gpu::BsdfQuery& q) const {
        const Material& m = materials_[q.material];
        if (m.kind != MaterialKind::Conductor) return 1.5 * 1.5;
        return (GetParam().exactLambda ? 1 : std::sqrt(kPi) / 0.95) * 1.0001; // rounding
    }
};

TEST_P(BsdfEnds, DirectionsAndWeightsAreInTheirDomains) {
    std::vector<gpu::BsdfQuery> queries;
    for (uint32_t material = 0; material < materials_.size(); ++material)
        for (const glm::vec3& wo : views())
            for (const glm::vec3& shading : {glm::vec3(0, 0, 1), glm::vec3(0.6f, 0, 0.8f)})
                for (const bool outside : {true, false})
                    for (const float u : kEnds)
                        for (const float v : kEnds) {
                            gpu::BsdfQuery q{};
                            q.material = material;
                            q.geometric = {0, 0, outside ? 1 : -1};
                            q.shading = shading;
                            q.wo = wo;
                            q.wi = {0, 0, 1};
                            q.outside = outside;
                            q.u = u, q.v = v, q.w = u;
                            queries.push_back(q);
                        }
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    size_t going = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const gpu::BsdfQuery& q = queries[i];
        const std::string at = std::to_string(q.material) + " u " + std::to_string(q.u) + " v " +
                               std::to_string(q.v) + " wo.z " + std::to_string(q.wo.z);
        const glm::dvec3 weight(found[i].weight);
        for (int c = 0; c < 3; ++c) {
            ASSERT_TRUE(std::isfinite(weight[c])) << at;
            ASSERT_GE(weight[c], 0) << at;
        }
        if (weight == glm::dvec3(0.0)) continue; // the path ends
        ++going;
        ASSERT_NEAR(glm::length(glm::dvec3(found[i].direction)), 1, 2e-6) << at; // fails for NaN
        ASSERT_LE(std::max({weight.x, weight.y, weight.z}), largestWeight(q)) << at;
        if (!GetParam().testsGeometricSide) continue;
        const double side = found[i].direction.z;
        ASSERT_GT((found[i].lobe & gpu::TRANSMISSION_LOBES) ? -side : side, 0) << at;
    }
    EXPECT_GT(going, queries.size() / 2);
}

INSTANTIATE_TEST_SUITE_P(Convention, BsdfEnds,
                         ::testing::Values(ShadingConventions{}, cs184Shading()),
                         [](const auto& c) {
                             return c.param == cs184Shading() ? "Cs184" : "Physical";
                         });

class AmbientEnds : public LightFixture {};

TEST_F(AmbientEnds, DirectionsAreAboveTheHorizon) {
    for (const bool upper : {false, true}) {
        Scene scene = sceneWithEmitter(glm::vec3(0.0f), true);
        Light light;
        light.kind = LightKind::Ambient;
        light.upperHemisphereOnly = upper;
        scene.lights.push_back(light);
        setScene(scene);
        for (const glm::vec3& n :
             {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(0.6f, -0.8f, 0)})
            for (const gpu::LightAnswer& a : answers(ends(surfaceAt({1, 2, 3}, n)))) {
                EXPECT_TRUE(isSound(a));
                EXPECT_GE(glm::dot(glm::dvec3(a.direction), glm::dvec3(n)), -1e-6);
                if (upper && a.direction.y <= 0) {
                    EXPECT_EQ(a.radiance, glm::vec3(0.0f)) << "from below the horizon";
                }
            }
    }
}

} // namespace
} // namespace stromboli::test
