#include "host/cs184/cs184.hpp"
#include "host/reference/bsdf.hpp"
#include "host/reference/interfaces.hpp"
#include "host/reference/microfacet.hpp"
#include "host/reference/sampling.hpp"
#include "tests/reference/directions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stromboli::reference {
namespace {

Material metal(float alpha) {
    Material m;
    m.kind = MaterialKind::Conductor;
    m.facets = {FacetDistribution::Beckmann, glm::vec2(alpha)};
    m.eta = {1.3f, 1.0f, 0.2f}, m.k = {7.3f, 0.5f, 3.9f};
    return m;
}

/// f.
glm::dvec3 reflected(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                     const ShadingConventions& conventions) {
    return evaluateFacetConductor(m, wo, wi, conventions).value / wi.z;
}

/// Reflects everything, so that f holds all of the geometry and nothing else.
Material perfectMetal(float alpha) {
    Material m = metal(alpha);
    m.eta = glm::vec3(1), m.k = glm::vec3(1e6f);
    return m;
}

/// Midpoint rule over the cell [c0, c1] x [p0, p1] of cosine and azimuth: f per solid angle.
template <class F>
double integrate(double c0, double c1, double p0, double p1, int n, F&& f) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            sum += f(direction(c0 + (c1 - c0) * (i + 0.5) / n, p0 + (p1 - p0) * (j + 0.5) / n));
    return sum * (c1 - c0) * (p1 - p0) / (n * n);
}

TEST(Microfacet, NormalsProjectToTheSurface) {
    for (const float alpha : {0.2f, 0.5f, 1.0f}) {
        const FacetModel facets(metal(alpha));
        EXPECT_NEAR(integrate(0, 1, 0, 2 * kPi, 1000,
                              [&](const glm::dvec3& h) { return facets.density(h) * h.z; }),
                    1, 1e-4);
    }
}

TEST(Microfacet, VisibleNormalsProjectToTheView) {
    // Smith's masking is defined by: integral of G1 max(0, w.h) D(h) dh = cos of w.
    for (const float alpha : {0.3f, 0.8f})
        for (double cosine : {0.2, 0.6, 1.0}) {
            const FacetModel facets(metal(alpha));
            const glm::dvec3 w = direction(cosine, 0.7);
            const double g1 = 1 / (1 + facets.lambda(w));
            const double projected = integrate(0, 1, 0, 2 * kPi, 1000, [&](const glm::dvec3& h) {
                return facets.density(h) * std::max(glm::dot(w, h), 0.0);
            });
            EXPECT_NEAR(g1 * projected, cosine, 1e-4);
        }
}

TEST(Microfacet, Reciprocity) {
    const Material m = metal(0.4f);
    for (double a : {0.05, 0.4, 0.9})
        for (double b : {0.1, 0.7, 1.0}) {
            const glm::dvec3 wo = direction(a, 0.3), wi = direction(b, 2.0);
            const glm::dvec3 f = reflected(m, wo, wi, {});
            const glm::dvec3 g = reflected(m, wi, wo, {});
            for (int c = 0; c < 3; ++c) {
                EXPECT_GT(f[c], 0);
                EXPECT_NEAR(f[c] / g[c], 1, 1e-12);
            }
        }
}

/// Pearson's statistic of sampled directions against the density, 10 x 20 cells of the upper
/// hemisphere and one for directions that leave it. Beyond mean + 4.5 deviations of chi-square
/// once in 1e5 tests.
TEST(Microfacet, SamplesFollowTheirDensity) {
    constexpr int kRows = 10, kColumns = 20, kSamples = 200000;
    for (float alpha : {0.15f, 0.5f, 1.0f})
        for (double cosine : {0.3, 0.9}) {
            const glm::dvec3 wo = direction(cosine, 1);
            const Material m = metal(alpha);
            const FacetModel facets(m);
            std::vector<double> counts(kRows * kColumns + 1), expected(counts.size());
            RandomStream random(0, 0, 1);
            for (int i = 0; i < kSamples; ++i) {
                const double u = random.next(), v = random.next();
                const glm::dvec3 h = facets.sampleVisible(wo, u, v);
                const glm::dvec3 wi = 2 * glm::dot(wo, h) * h - wo;
                double azimuth = std::atan2(wi.y, wi.x);
                if (azimuth < 0) azimuth += 2 * kPi;
                const int row = std::min(int(wi.z * kRows), kRows - 1);
                const int column = std::min(int(azimuth / (2 * kPi) * kColumns), kColumns - 1);
                ++counts[wi.z > 0 ? row * kColumns + column : kRows * kColumns];
            }
            double total = 0;
            for (int row = 0; row < kRows; ++row)
                for (int column = 0; column < kColumns; ++column) {
                    const double share = integrate(
                        double(row) / kRows, (row + 1.0) / kRows, 2 * kPi * column / kColumns,
                        2 * kPi * (column + 1) / kColumns, 60, [&](const glm::dvec3& wi) {
                            return evaluateFacetConductor(m, wo, wi, {}).pdf;
                        });
                    expected[row * kColumns + column] = share * kSamples;
                    total += share;
                }
            EXPECT_LE(total, 1 + 1e-3);
            expected.back() = (1 - total) * kSamples;
            double statistic = 0, pooledCount = 0, pooledExpected = 0;
            int cells = 0;
            for (size_t i = 0; i < counts.size(); ++i) {
                if (expected[i] < 10) { // too few for the chi-square approximation: one cell
                    pooledCount += counts[i], pooledExpected += expected[i];
                    continue;
                }
                statistic += std::pow(counts[i] - expected[i], 2) / expected[i];
                ++cells;
            }
            if (pooledExpected >= 10) {
                statistic += std::pow(pooledCount - pooledExpected, 2) / pooledExpected;
                ++cells;
            }
            EXPECT_LT(statistic, cells - 1 + 4.5 * std::sqrt(2.0 * (cells - 1)))
                << "alpha " << alpha << ", cosine " << cosine;
        }
}

/// Share of the light from wo that comes back, estimated with sampleBsdf().
double albedo(const Material& m, double cosine, const ShadingConventions& conventions) {
    SurfacePoint s;
    s.material = &m;
    s.wo = direction(cosine, 0.5);
    double sum = 0;
    constexpr uint32_t kSamples = 20000;
    for (uint32_t i = 0; i < kSamples; ++i) {
        RandomStream random(7, i, 0);
        sum += sampleBsdf(s, random.threeNumbers(), conventions).weight.x / kSamples;
    }
    return sum;
}

TEST(Microfacet, ReflectsNoMoreThanItReceives) {
    for (float alpha : {0.05f, 0.2f, 0.5f, 1.0f})
        for (double cosine : {0.01, 0.1, 0.5, 1.0})
            // Single scattering loses energy; 1e-3 is several standard errors of 20000 samples of
            // a weight close to 1.
            EXPECT_LE(albedo(perfectMetal(alpha), cosine, {}), 1 + 1e-3);
}

TEST(Microfacet, SmoothLimitIsAMirror) {
    const Material m = metal(1e-3f);
    for (double cosine : {0.3, 0.8})
        EXPECT_NEAR(albedo(m, cosine, {}), conductor(cosine, m.eta, m.k).x, 1e-4);
}

TEST(Microfacet, SampledAlbedoIsTheIntegralOfF) {
    for (const ShadingConventions& conventions : {ShadingConventions{}, cs184Shading()}) {
        const Material m = metal(0.5f);
        const glm::dvec3 wo = direction(0.6, 0.5);
        const double integral = integrate(0, 1, 0, 2 * kPi, 500, [&](const glm::dvec3& wi) {
            return reflected(m, wo, wi, conventions).x * wi.z;
        });
        EXPECT_NEAR(albedo(m, 0.6, conventions), integral, 0.015);
    }
}

TEST(Microfacet, EvaluationNeedsBothDirectionsAbove) {
    const Material m = metal(0.5f);
    const glm::dvec3 up(0.6, 0, 0.8), down(0.6, 0, -0.8);
    EXPECT_EQ(reflected(m, up, down, {}), glm::dvec3(0.0));
    EXPECT_EQ(reflected(m, down, up, {}), glm::dvec3(0.0));
}

TEST(Microfacet, FormsThatAreNotExact) {
    // Written out by hand for alpha 1, wo = wi = (0.8, 0, 0.6): h = that, tan = 4 / 3.
    const Material m = metal(1);
    const glm::dvec3 w(0.8, 0, 0.6);
    const double d = std::exp(-16.0 / 9) / (kPi * 0.6 * 0.6 * 0.6 * 0.6), rest = d / (4 * 0.36);
    const double a = 0.75;
    const double lambda = (std::erf(a) - 1 + std::exp(-a * a) / (a * kPi)) / 2;
    const double s = 1.3 * 1.3 + 7.3 * 7.3, c = 0.6;
    const double rs = (s - 2 * 1.3 * c + c * c) / (s + 2 * 1.3 * c + c * c);
    const double rp = (s * c * c - 2 * 1.3 * c + 1) / (s * c * c + 2 * 1.3 * c + 1);
    const double fresnel = (rs + rp) / 2, masking = 1 / (1 + 2 * lambda);
    const double exactFresnel = conductor(1, m.eta, m.k).x;
    const double exactMasking = 1 / (1 + 2 * FacetModel(m).lambda(w));
    const auto relative = [&](const ShadingConventions& conventions, double f, double g) {
        return reflected(m, w, w, conventions).x / (f * g * rest);
    };
    EXPECT_NEAR(relative({}, exactFresnel, exactMasking), 1, 1e-6);
    EXPECT_NEAR(relative({.exactFresnel = false}, fresnel, exactMasking), 1, 1e-6);
    EXPECT_NEAR(relative({.exactLambda = false}, exactFresnel, masking), 1, 1e-6);
    EXPECT_NEAR(relative({.exactFresnel = false, .exactLambda = false}, fresnel, masking), 1, 1e-6);
    EXPECT_GT(std::abs(exactFresnel / fresnel - 1), 1e-3); // the test can tell them apart
    EXPECT_GT(std::abs(exactMasking / masking - 1), 1e-3);
}

} // namespace
} // namespace stromboli::reference
