// GGX, and the fits of albedos by which the principled material's layers are defined, against
// integrals.
#include "host/reference/microfacet.hpp"
#include "host/reference/principled.hpp"
#include "host/reference/sampling.hpp"
#include "shaders/shared/albedo_fits.h"
#include "shaders/shared/bsdf_types.h"
#include "tests/reference/directions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::reference {
namespace {

template <class F>
double overHemisphere(int n, F&& f) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) // cosines are squared, so that grazing ones are resolved
            sum += f(direction(std::pow((i + 0.5) / n, 2), 2 * kPi * (j + 0.5) / n)) *
                   (2 * (i + 0.5) / n) * (2 * kPi) / (double(n) * n);
    return sum;
}

TEST(Ggx, NormalsProjectToTheSurfaceAndToTheView) {
    for (const Ggx ggx : {Ggx{0.3, 0.3}, Ggx{0.8, 0.2}, Ggx{1, 1}}) {
        EXPECT_NEAR(overHemisphere(1000, [&](const glm::dvec3& h) { return ggx.density(h) * h.z; }),
                    1, 2e-4);
        for (const double cosine : {0.2, 0.6, 1.0})
            EXPECT_NEAR(overHemisphere(1000,
                                       [&](const glm::dvec3& h) {
                                           return ggx.visibleDensity(direction(cosine, 0.7), h);
                                       }),
                        1, 2e-4)
                << cosine;
    }
}

/// The mean of what samples of visible normals weigh, all facets reflecting 1, and of (1 - cos)^5.
struct Albedo {
    double whole = 0, schlick = 0;
};

Albedo albedoOf(double mu, double alpha) {
    constexpr int kU = 256, kV = 64;
    const Ggx ggx{alpha, alpha};
    const glm::dvec3 wo = direction(mu, 0);
    Albedo sum;
    for (int i = 0; i < kU; ++i)
        for (int j = 0; j < kV; ++j) {
            const glm::dvec3 h = ggx.sampleVisible(wo, (i + 0.5) / kU, (j + 0.5) / kV);
            const double cosine = glm::dot(wo, h);
            const glm::dvec3 wi = 2 * cosine * h - wo;
            if (!(wi.z > 0)) continue;
            const double weight = ggx.visibleFromBoth(wo, wi) * (1 + ggx.lambda(wo));
            sum.whole += weight / (kU * kV);
            sum.schlick += weight * std::pow(1 - cosine, 5) / (kU * kV);
        }
    return sum;
}

TEST(AlbedoFits, OfGgxAreAsGoodAsTheySay) {
    double worst = 0, worstShare = 0;
    for (const double alpha : {1e-4, 1e-3, 0.01, 0.03, 0.09, 0.2, 0.36, 0.5, 0.7, 0.85, 1.0})
        for (const double mu :
             {1e-4, 1e-3, 0.005, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0}) {
            const Albedo exact = albedoOf(mu, alpha);
            worst = std::max(worst, std::abs(gpu::ggxAlbedo(mu, alpha) / exact.whole - 1));
            worstShare = std::max(
                worstShare, std::abs(gpu::schlickShare(mu, alpha) - exact.schlick / exact.whole));
        }
    EXPECT_LT(worst, 0.0042);
    EXPECT_LT(worstShare, 0.0075);
}

TEST(AlbedoFits, OfTheMeanIsAsGoodAsItSays) {
    constexpr int kViews = 64;
    for (const double alpha : {0.01, 0.09, 0.25, 0.5, 0.75, 1.0}) {
        double mean = 0; // the mean over squared cosines is that weighted with them
        for (int i = 0; i < kViews; ++i)
            mean += albedoOf(std::sqrt((i + 0.5) / kViews), alpha).whole / kViews;
        EXPECT_NEAR(gpu::ggxMeanAlbedo(alpha), mean, 0.0031) << alpha;
    }
}

/// Light that meets facets of one reflectance F again and again, the share Em leaving each time, is
/// a geometric series: F Em / (1 - F (1 - Em)) of all light that comes from everywhere is
/// reflected.
TEST(Principled, WhatFacetsScatterAgainLosesWhatTheyAbsorb) {
    constexpr int kViews = 24;
    PrincipledParameters p;
    p.metallic = 0;
    p.baseColor = glm::vec3(0);
    p.ior = 1e4f; // reflects as much at every angle
    for (const float reflectance : {0.2f, 0.5f, 0.9f})
        for (const float alpha : {0.25f, 1.0f}) {
            p.specular = reflectance;
            p.roughness = std::sqrt(alpha);
            double albedo = 0;
            for (int i = 0; i < kViews; ++i) {
                const glm::dvec3 wo = direction(std::sqrt((i + 0.5) / kViews), 0);
                albedo += overHemisphere(120,
                                         [&](const glm::dvec3& wi) {
                                             return evaluatePrincipled(p, wo, true, wi).value.x;
                                         }) /
                          kViews;
            }
            const double first = gpu::ggxMeanAlbedo(double(alpha));
            EXPECT_NEAR(albedo, reflectance * first / (1 - reflectance * (1 - first)), 0.006)
                << reflectance << ' ' << alpha;
        }
}

/// GGX of alpha 1 reflects at a right angle 1 - ln 2 at first.
TEST(AlbedoFits, KnowTheClosedForm) {
    EXPECT_NEAR(albedoOf(1, 1).whole, 1 - std::log(2.0), 1e-4);
}

/// The sheen of a material without anything below it.
TEST(AlbedoFits, OfSheenAreAsGoodAsTheySayAndNothingIsGained) {
    double above = 0, below = 0;
    PrincipledParameters p;
    p.metallic = 0;
    p.baseColor = p.specularColor = glm::vec3(0);
    p.specular = 0;
    p.sheenColor = glm::vec3(1);
    for (const double alpha : {0.07, 0.1, 0.2, 0.4, 0.7, 1.0}) {
        p.sheenRoughness = float(std::sqrt(alpha));
        for (const double mu : {1e-3, 0.01, 0.05, 0.1, 0.3, 0.6, 0.9, 1.0}) {
            const double exact = overHemisphere(300, [&](const glm::dvec3& wi) {
                return evaluatePrincipled(p, direction(mu, 0), true, wi).value.x;
            });
            EXPECT_LT(exact, 1) << alpha << ' ' << mu;
            const double error = gpu::sheenAlbedo(mu, alpha) - exact;
            above = std::max(above, error), below = std::max(below, -error);
        }
    }
    EXPECT_LT(above, 0.033);
    EXPECT_LT(below, 1e-3);
}

/// Nothing that a narrow lobe divides by is 0, and no two lobes jump where the least roughness
/// ends.
TEST(Principled, IsContinuousDownToAMirror) {
    PrincipledParameters p;
    const glm::dvec3 wo = direction(0.7, 0.3), wi(-wo.x, -wo.y, wo.z);
    p.roughness = 0;
    const BsdfValue mirror = evaluatePrincipled(p, wo, true, wi);
    p.roughness = 0.0100001f;
    const BsdfValue nearly = evaluatePrincipled(p, wo, true, wi);
    EXPECT_NEAR(mirror.value.x / nearly.value.x, 1, 1e-4);
    EXPECT_NEAR(mirror.value.x / mirror.pdf, 1, 0.005);
}

/// Clear glass about a volume is a dielectric between two planes; a sheet reflects by Schlick's
/// formula, and lets the rest through, straight on.
TEST(Principled, ClearGlassIsADielectric) {
    Material clear, plain;
    clear.kind = MaterialKind::Principled, plain.kind = MaterialKind::Dielectric;
    clear.principled = {.baseColor = {0.9f, 0.7f, 0.5f}, .metallic = 0, .roughness = 0};
    clear.principled.transmission = 1, clear.principled.isThin = false;
    plain.transmittance = clear.principled.baseColor;
    SurfacePoint a, b;
    a.material = &clear, b.material = &plain;
    for (const double mu : {0.05, 0.3, 0.7, 1.0})
        for (const bool isOutside : {true, false})
            for (const double u : {0.001, 0.999}) {
                a.wo = b.wo = direction(mu, 0.4);
                a.outside = b.outside = isOutside;
                const BsdfSample s = sampleBsdf(a, {0.5, 0.5, u}, {}),
                                 t = sampleBsdf(b, {0.5, 0.5, u}, {});
                EXPECT_EQ(s.lobe, t.lobe) << mu << ' ' << isOutside << ' ' << u;
                EXPECT_LT(glm::length(s.direction - t.direction), 1e-6);
                EXPECT_LT(glm::length(s.weight - t.weight), 1e-6);
                EXPECT_EQ(evaluateBsdf(a, t.direction, {}).pdf, 0);
            }
    clear.principled.isThin = true;
    const double mu = 0.3, mirrored = 0.04 + 0.96 * std::pow(1 - mu, 5);
    a.wo = direction(mu, 0.4);
    const BsdfSample on = sampleBsdf(a, {0.5, 0.5, 0.999}, {});
    EXPECT_EQ(on.lobe, gpu::LOBE_DELTA_TRANSMISSION);
    EXPECT_LT(glm::length(on.direction + a.wo), 1e-12);
    EXPECT_LT(glm::length(on.weight * on.chosen -
                          (1 - mirrored) * glm::dvec3(clear.principled.baseColor)),
              1e-6);
}

} // namespace
} // namespace stromboli::reference
