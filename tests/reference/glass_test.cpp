#include "host/reference/bsdf.hpp"
#include "host/reference/microfacet.hpp"
#include "host/reference/sampling.hpp"
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;
using reference::BsdfSample;
using reference::RandomStream;
using reference::SurfacePoint;

TEST(Glass, RefractionBendsBySnellsLaw) {
    const Material m = [] {
        Material refraction = glass(1.5f);
        refraction.kind = MaterialKind::Refraction;
        return refraction;
    }();
    SurfacePoint s;
    s.material = &m;
    RandomStream random(0, 0, 0);
    s.wo = {0.6, 0, 0.8};
    const BsdfSample in = sampleBsdf(s, random.threeNumbers(), {});
    EXPECT_NEAR(in.direction.x, -0.4, 1e-12);
    EXPECT_NEAR(in.direction.z, -std::sqrt(1 - 0.16), 1e-12);
    EXPECT_NEAR(in.weight.x, 1 / 2.25, 1e-12);

    s.outside = false; // the same ray from inside the glass
    const BsdfSample out = sampleBsdf(s, random.threeNumbers(), {});
    EXPECT_NEAR(out.direction.x, -0.9, 1e-12);
    EXPECT_NEAR(out.weight.x, 2.25, 1e-12);

    s.wo = {0.8, 0, 0.6}; // 1.5 * 0.8 > 1: total reflection
    EXPECT_EQ(sampleBsdf(s, random.threeNumbers(), {}).weight, glm::dvec3(0.0));
}

TEST(Glass, RadianceIsCompressedOrByConventionTheOtherWay) {
    Material m = glass(1.5f);
    m.kind = MaterialKind::Refraction;
    SurfacePoint s;
    s.material = &m;
    RandomStream random(0, 0, 0);
    const BsdfSample in = sampleBsdf(s, random.threeNumbers(), {.compressesRadiance = false});
    EXPECT_NEAR(in.weight.x, 2.25, 1e-12);
    s.outside = false;
    const BsdfSample out = sampleBsdf(s, random.threeNumbers(), {.compressesRadiance = false});
    EXPECT_NEAR(out.weight.x, 1 / 2.25, 1e-12);
}

/// Light from below the true surface, above the horizon of its shading normal.
TEST(Diffuse, LightStaysOnItsSideOfTheSurfaceUnlessByConvention) {
    const Material m;
    SurfacePoint s;
    s.material = &m;
    s.wo = {0, 0, 1};
    s.shading = {0.6, 0, 0.8};
    const glm::dvec3 below = glm::normalize(glm::dvec3(1, 0, -0.1));
    EXPECT_EQ(reference::evaluateBsdf(s, below, {}).pdf, 0);
    EXPECT_GT(reference::evaluateBsdf(s, below, {.testsGeometricSide = false}).pdf, 0);
}

TEST(Glass, TotalReflectionIsCertain) {
    const Material m = glass(1.5f);
    SurfacePoint s;
    s.material = &m;
    s.wo = {0.8, 0, 0.6};
    s.outside = false;
    for (const bool facesForward : {true, false}) {
        if (!facesForward) s.shading = {0, 0, -1}; // inside is below its normal
        for (uint32_t i = 0; i < 1000; ++i) {
            RandomStream random(0, i, 0);
            const BsdfSample sample =
                sampleBsdf(s, random.threeNumbers(), {.facesForward = facesForward});
            EXPECT_NEAR(glm::distance(sample.direction, {-0.8, 0, 0.6}), 0, 1e-12);
            EXPECT_EQ(sample.weight, glm::dvec3(1.0));
        }
    }
}

TEST(Fresnel, Dielectric) {
    EXPECT_NEAR(reference::dielectric(1, 1 / 1.5).reflectance, 0.04, 1e-12);
    EXPECT_NEAR(reference::dielectric(1, 1.5).reflectance, 0.04, 1e-12);
    EXPECT_NEAR(reference::dielectric(1e-12, 1 / 1.5).reflectance, 1, 1e-9);
    // At Brewster's angle only s light is reflected: cos^2 of twice the angle.
    const double brewster = std::atan(1.5);
    const double s = std::pow(std::cos(2 * brewster), 2);
    EXPECT_NEAR(reference::dielectric(std::cos(brewster), 1 / 1.5).reflectance, s / 2, 1e-12);
    // And from the other side of the refracted ray.
    const reference::Interface in = reference::dielectric(0.3, 1 / 1.5);
    EXPECT_NEAR(reference::dielectric(in.cosTransmitted, 1.5).reflectance, in.reflectance, 1e-12);
}

TEST(Fresnel, Conductor) {
    const glm::dvec3 eta(1.3, 1.0, 0.2), k(7.3, 0.0, 3.9);
    const glm::dvec3 straight = reference::conductor(1, eta, k);
    for (int c = 0; c < 3; ++c) {
        const double expected = ((eta[c] - 1) * (eta[c] - 1) + k[c] * k[c]) /
                                ((eta[c] + 1) * (eta[c] + 1) + k[c] * k[c]);
        EXPECT_NEAR(straight[c], expected, 1e-12);
    }
    // Without absorption it is a dielectric.
    EXPECT_NEAR(reference::conductor(0.4, glm::dvec3(1.5), glm::dvec3(0.0)).x,
                reference::dielectric(0.4, 1 / 1.5).reflectance, 1e-12);
    for (double cosine : {1e-6, 0.1, 0.5, 0.9, 1.0}) {
        const glm::dvec3 f = reference::conductor(cosine, eta, k);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(f[c], 0);
            EXPECT_LE(f[c], 1);
        }
    }
}

TEST(Glass, ReflectsBySchlickWhereFresnelIsNotExact) {
    using namespace reference;
    const Material m = glass(1.5f);
    SurfacePoint s;
    s.material = &m;
    s.wo = {std::sqrt(0.96), 0, 0.2};
    const double expected = 0.04 + 0.96 * std::pow(0.8, 5);
    constexpr uint32_t kSamples = 40000;
    double reflected = 0;
    for (uint32_t i = 0; i < kSamples; ++i) {
        RandomStream random(0, i, 0);
        if (sampleBsdf(s, random.threeNumbers(), {.exactFresnel = false}).direction.z > 0)
            reflected += 1.0 / kSamples;
    }
    EXPECT_NEAR(reflected, expected, 4.5 * std::sqrt(expected * (1 - expected) / kSamples));
}

} // namespace
} // namespace stromboli
