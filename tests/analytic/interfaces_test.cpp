// Conductors, rough and thin dielectrics and plastic in pictures: reflectances and albedos that
// have closed forms, white furnaces, and light that every way of finding light finds alike.
#include "tests/analytic/scenes.hpp"
#include "tests/analytic/textured.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stromboli {
namespace {

using namespace test;

const glm::vec3 kEta(0.143f, 0.375f, 1.442f), kK(3.983f, 2.386f, 1.603f); // gold, about

constexpr FacetDistribution kDistributions[] = {FacetDistribution::Ggx,
                                                FacetDistribution::Beckmann};

Material ofKind(MaterialKind kind, float alpha = 0,
                FacetDistribution distribution = FacetDistribution::Ggx) {
    Material m;
    m.kind = kind;
    m.facets = {.distribution = distribution, .alpha = glm::vec2(alpha)};
    return m;
}

Material gold(float alpha = 0, FacetDistribution distribution = FacetDistribution::Ggx) {
    Material m = ofKind(MaterialKind::Conductor, alpha, distribution);
    m.eta = kEta, m.k = kK;
    return m;
}

Scene sheetInAmbientLight(const Material& material) {
    SceneMaker b;
    b.quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0}, b.add(material));
    b.add(ambient(1));
    return b.scene;
}

const Camera kStraight = pointCamera({0.3, 0.2, 2}, {0.3, 0.2, 0});
const double kTilt = std::cos(std::atan(2.0));
const Camera kTilted = pointCamera({4, 0, 2}, {0, 0, 0}); // at the cosine kTilt

RenderSettings pathsOf(uint32_t samples, uint32_t bounces, DirectLight direct) {
    RenderSettings s = smallPicture(samples, bounces);
    s.estimator.directLight = direct;
    return s;
}

/// Reflectance of one interface, unpolarised, from the less dense side.
double fresnel(double cosine, double ior) {
    const double t = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
    const double s = (cosine - ior * t) / (cosine + ior * t);
    const double p = (ior * cosine - t) / (ior * cosine + t);
    return (s * s + p * p) / 2;
}

glm::dvec3 atNormalIncidence(const glm::dvec3& eta, const glm::dvec3& k) {
    return ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k);
}

TEST(Conductor, ReflectsWhatItsIndexSaysAtNormalIncidence) {
    Material m = gold();
    m.reflectance = {1, 0.5f, 0.25f};
    const glm::dvec3 expected = atNormalIncidence(kEta, kK) * glm::dvec3(m.reflectance);
    const Estimate found = estimate(sheetInAmbientLight(m), kStraight, smallPicture(4, 3));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c], 2e-5);
}

/// Neither distribution jumps where facets become a plane.
TEST(Conductor, NarrowFacetsReflectWhatAPlaneDoes) {
    for (const Camera& camera : {kStraight, kTilted}) {
        const Estimate plane =
            estimate(sheetInAmbientLight(gold(0.99e-4f)), camera, smallPicture(4, 3));
        for (const FacetDistribution d : kDistributions) {
            const Estimate facets =
                estimate(sheetInAmbientLight(gold(1.01e-4f, d)), camera, smallPicture(16, 3));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(facets.mean[c], plane.mean[c], 1e-4 + 4.5 * facets.error[c]) << int(d);
        }
    }
}

/// Base colours multiply the reflectance; green and blue of roughness the alphas, which are never
/// made smooth.
TEST(Conductor, HasTextures) {
    SceneMaker b;
    TextureMaker t(b.scene);
    Material m = gold(1);
    m.textures = {{.slot = TextureSlot::BaseColor, .texture = t.constant({0.5f, 0.25f, 1, 1})},
                  {.slot = TextureSlot::MetallicRoughness, .texture = t.constant({1, 0, 0, 1})}};
    addTexturedSquare(b, b.add(m));
    b.add(ambient(1));
    const Camera camera = pointCamera({0.5, 0.5, 2}, {0.5, 0.5, 0});
    const glm::dvec3 expected = atNormalIncidence(kEta, kK) * glm::dvec3(0.5, 0.25, 1);
    const Estimate found = estimate(b.scene, camera, smallPicture(16, 3));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c], 1e-4);
}

/// What facets that reflect all keep at the first reflection; seen at a right angle, GGX of alpha 1
/// keeps 1 - ln 2 (tests/reference/principled_test.cpp).
TEST(Conductor, WhiteFacetsLoseOnlyWhatTheyWouldReflectAgain) {
    for (const FacetDistribution d : kDistributions)
        for (const float alpha : {0.1f, 0.5f, 1.0f}) {
            Material m = ofKind(MaterialKind::Conductor, alpha, d);
            m.eta = glm::vec3(0), m.k = glm::vec3(1); // reflects all
            const Scene scene = sheetInAmbientLight(m);
            const Estimate byBounces =
                estimate(scene, kStraight, pathsOf(900, 2, DirectLight::Bsdf));
            EXPECT_LT(byBounces.mean.x, 1 + kRounding + 4.5 * byBounces.error.x);
            EXPECT_GT(byBounces.mean.x, 1 - 0.8 * alpha);
            expectSameMean(estimate(scene, kStraight, pathsOf(900, 2, DirectLight::Mis)),
                           byBounces);
            if (alpha == 1 && d == FacetDistribution::Ggx) expectMean(byBounces, 1 - std::log(2.0));
        }
}

/// An emitter seen through the sheet, and one that is mirrored in it: with R of one interface, all
/// reflections inside make 2 R / (1 + R) and (1 - R) / (1 + R).
TEST(ThinDielectric, HasAllReflectionsInside) {
    Material m = ofKind(MaterialKind::ThinDielectric);
    m.ior = 1.5f;
    m.reflectance = {1, 0.5f, 0.2f};
    m.transmittance = {0.3f, 0.6f, 1};
    const double r = fresnel(kTilt, 1.5);
    for (const bool behind : {true, false}) {
        SceneMaker b;
        b.quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0}, b.add(m));
        const float z = behind ? -2.0f : 2.0f; // wide, but not in the way of the camera
        b.quad({-9, -9, z}, {8, 0, 0}, {0, 18, 0}, b.add(emissive(1)));
        const glm::dvec3 expected = behind ? glm::dvec3(m.transmittance) * (1 - r) / (1 + r)
                                           : glm::dvec3(m.reflectance) * 2.0 * r / (1 + r);
        expectMean(estimate(b.scene, kTilted, smallPicture(4000, 3)), expected);
    }
}

/// A sheet made of two interfaces of glass.
TEST(ThinDielectric, IsASlabOfGlass) {
    SceneMaker b;
    b.box({-100, -100, -0.01f}, {100, 100, 0}, b.add(glass(1.5f)));
    const uint32_t light = b.add(emissive(1));
    b.quad({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, light);
    const Estimate slab = estimate(b.scene, kStraight, smallPicture(4000, 40));
    SceneMaker thin;
    thin.quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0},
              thin.add(ofKind(MaterialKind::ThinDielectric)));
    thin.quad({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, thin.add(emissive(1)));
    expectSameMean(estimate(thin.scene, kStraight, smallPicture(4000, 3)), slab);
}

TEST(RoughDielectric, WhiteSphereLosesLittleWhereItIsNearlySmooth) {
    for (const FacetDistribution d : kDistributions)
        for (const float alpha : {2e-4f, 0.05f}) {
            const Estimate found =
                estimate(sphereInAmbientLight(ofKind(MaterialKind::Dielectric, alpha, d)), kOutside,
                         smallPicture(64, 200));
            EXPECT_LT(found.mean.x, 1 + kRounding + 4.5 * found.error.x);
            EXPECT_GT(found.mean.x, 0.98 - 4.5 * found.error.x) << alpha;
        }
}

/// Just below and above the least alpha: the sphere is one of glass.
TEST(RoughDielectric, NarrowFacetsAreGlass) {
    SceneMaker b;
    Material m = ofKind(MaterialKind::Dielectric);
    m.transmittance = {0.9f, 0.5f, 0.2f};
    m.reflectance = {0.3f, 0.5f, 1};
    b.sphere({0, 0, 0}, 1, b.add(m));
    b.quad({-3, -3, -3}, {6, 0, 0}, {0, 4, 0}, b.add(emissive(2)));
    b.quad({2, -3, 3}, {6, 0, 0}, {0, 6, 0}, b.add(emissive(1)));
    const auto with = [&](float alpha, FacetDistribution d) {
        b.scene.materials[0].facets = {d, glm::vec2(alpha)};
        return estimate(b.scene, kOutside, smallPicture(400, 8));
    };
    const Estimate plane = with(0, FacetDistribution::Ggx);
    for (const FacetDistribution d : kDistributions) {
        expectSameMean(with(0.99e-4f, d), plane);
        expectSameMean(with(1.01e-4f, d), plane);
    }
}

/// Every way of finding light finds the same, from both sides of a rough interface and from
/// plastic, whose interface is a delta lobe or facets.
TEST(Interfaces, LightIsFoundAlikeInEveryWay) {
    Material rough = ofKind(MaterialKind::Dielectric, 0, FacetDistribution::Beckmann);
    rough.facets.alpha = {0.6f, 0.3f};
    rough.transmittance = {0.9f, 0.7f, 0.5f};
    Material plastic = ofKind(MaterialKind::Plastic);
    plastic.albedo = {0.9f, 0.5f, 0.2f};
    Material roughPlastic = plastic;
    roughPlastic.facets.alpha = glm::vec2(0.3f);
    for (const Material& m : {rough, plastic, roughPlastic}) {
        SceneMaker b;
        const uint32_t own = b.add(m), light = b.add(emissive(8)), floor = b.add(diffuse(0.6f));
        b.box({-1, -1, -0.4f}, {1, 1, 0}, own);
        b.quad({-0.5f, -0.5f, -2}, {1, 0, 0}, {0, 1, 0}, light);
        b.sphere({1.5f, 1, 1.5f}, 0.4f, light);
        b.quad({-4, -1.2f, -4}, {0, 0, 8}, {8, 0, 0}, floor);
        const Camera camera = pointCamera({0.4, 0.3, 4}, {0.1, 0, 0}, 0.15);
        const Estimate byBounces = estimate(b.scene, camera, pathsOf(400, 4, DirectLight::Bsdf));
        for (const DirectLight direct : {DirectLight::Lights, DirectLight::Mis, DirectLight::MisAll,
                                         DirectLight::Hemisphere}) {
            if (!isAnotherWay(direct)) continue;
            SCOPED_TRACE(std::string(nameOf(direct)) + ' ' + std::to_string(int(m.kind)));
            expectSameMean(estimate(b.scene, camera, pathsOf(400, 4, direct)), byBounces);
        }
    }
}

/// An interface sends back 0.5963 of diffuse light inside glass of index 1.5 (Duntley 1942).
constexpr double kInternal = 0.59631;

/// The sum over all reflections between base and interface: f + (1 - f) a (1 - F) / (1 - a F) with
/// the base's own albedo a, or with the colour of one reflection only, f + (1 - f) a.
TEST(Plastic, HasTheAlbedoOfItsSeries) {
    for (const bool isNonlinear : {false, true})
        for (const auto& [camera, cosine] :
             {std::pair(kStraight, 1.0), std::pair(kTilted, kTilt)}) {
            Material m = ofKind(MaterialKind::Plastic);
            m.albedo = {1, 0.5f, 0.1f};
            m.reflectance = {1, 0.5f, 0};
            m.isNonlinear = isNonlinear;
            const double f = fresnel(cosine, m.ior);
            glm::dvec3 expected;
            for (int c = 0; c < 3; ++c) {
                const double a = m.albedo[c];
                const double base = isNonlinear ? a * (1 - kInternal) / (1 - a * kInternal) : a;
                expected[c] = f * m.reflectance[c] + (1 - f) * base;
            }
            for (const DirectLight direct : {DirectLight::Mis, DirectLight::Bsdf}) {
                const Estimate found =
                    estimate(sheetInAmbientLight(m), camera, pathsOf(2500, 3, direct));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(found.mean[c], expected[c], 4.5 * found.error[c] + 1e-4)
                        << isNonlinear << ' ' << c << ' ' << nameOf(direct);
            }
        }
}

/// What a rough interface would scatter again is lost, and nothing is gained; a narrow one is
/// smooth.
TEST(Plastic, RoughInterfacesGainNothing) {
    for (const FacetDistribution d : kDistributions)
        for (const float alpha : {1.01e-4f, 0.2f, 1.0f})
            for (const Camera& camera : {kStraight, kTilted}) {
                Material m = ofKind(MaterialKind::Plastic, alpha, d);
                m.albedo = glm::vec3(1);
                const Estimate found =
                    estimate(sheetInAmbientLight(m), camera, pathsOf(900, 3, DirectLight::Mis));
                EXPECT_LT(found.mean.x, 1 + 1e-3 + 4.5 * found.error.x) << alpha;
                const double least = alpha < 0.01f ? 1 - 1e-3 : alpha < 0.5f ? 0.78 : 0.29;
                EXPECT_GT(found.mean.x, least - 4.5 * found.error.x) << alpha;
            }
}

} // namespace
} // namespace stromboli
