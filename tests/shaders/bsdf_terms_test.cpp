// The terms of the BSDFs against formulas in double precision: host/reference where it has them,
// docs/guide/cs184.md.
#include "host/core/random.hpp"
#include "host/reference/microfacet.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/bsdf_terms_shader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

using gpu::TermAnswer;
using gpu::TermQuery;

constexpr double kUlp = 0x1p-23;

class BsdfTerms : public DeviceTest {
  protected:
    std::vector<TermAnswer> answers(const std::vector<TermQuery>& queries, bool departs = false) {
        return ask<TermAnswer>(bsdf_terms_shader, queries,
                               ShaderOptions().set(SPEC_DEPARTURES, departs ? ~0u : 0u));
    }
};

/// Abramowitz and Stegun 7.1.26 is good to 1.5e-7; exp to 3 + 2 x^2 ulp of its value (Vulkan), the
/// polynomial and the difference to some 6.
TEST_F(BsdfTerms, Erf) {
    std::vector<TermQuery> queries;
    for (int i = 0; i <= 6000; ++i)
        queries.push_back({{1, 1, 1}, float(i) * 1e-3f, {0, 0, 0}, 1});
    queries.push_back({{1, 1, 1}, 1e3f, {0, 0, 0}, 1});
    queries.push_back({{1, 1, 1}, 1e30f, {0, 0, 0}, 1});
    const std::vector<TermAnswer> found = answers(queries);
    for (size_t i = 0; i < found.size(); ++i) {
        const double x = queries[i].x;
        const double relative = (3 + 2 * x * x + 6) * kUlp * std::erfc(x);
        EXPECT_NEAR(found[i].erf, std::erf(x), 1.5e-7 + relative + kUlp) << x;
    }
}

TEST_F(BsdfTerms, SmithLambda) {
    for (const bool departs : {false, true}) {
        std::vector<TermQuery> queries;
        for (const float alpha : {0.01f, 0.1f, 0.25f, 1.0f})
            for (int i = 1; i <= 1000; ++i)
                queries.push_back({{1, 1, 1}, float(i) * 1e-3f, {0, 0, 0}, alpha});
        const std::vector<TermAnswer> found = answers(queries, departs);
        for (size_t i = 0; i < found.size(); ++i) {
            const double c = queries[i].x, alpha = queries[i].alpha;
            const double a = c / (alpha * std::sqrt(1 - c * c));
            double expected = 0;
            if (c < 1 && departs)
                expected = (std::erf(a) - 1 + std::exp(-a * a) / (a * kPi)) / 2;
            else if (c < 1)
                expected = -std::erfc(a) / 2 + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
            // 1 - c^2 loses digits where c nears 1; there a is large and Lambda 0.
            EXPECT_NEAR(found[i].lambda, expected, 1e-6 + 20 * kUlp * std::abs(expected))
                << c << ' ' << alpha;
        }
    }
}

TEST_F(BsdfTerms, ConductorFresnel) {
    Random random(91);
    std::vector<TermQuery> queries;
    const glm::vec3 metals[][2] = {{{1.3352f, 1.0109f, 0.68955f}, {7.3398f, 6.6157f, 5.6471f}},
                                   {{0.2f, 0.92f, 1.1f}, {3.9f, 2.45f, 2.14f}}};
    for (const auto& metal : metals)
        for (int i = 0; i <= 1000; ++i)
            queries.push_back({metal[0], float(i) * 1e-3f, metal[1], 1});
    for (int i = 0; i < 20000; ++i) {
        const auto three = [&](float a, float b) {
            const float x = random.uniform(a, b), y = random.uniform(a, b);
            return glm::vec3(x, y, random.uniform(a, b));
        };
        queries.push_back({three(0.1f, 4), random.uniform(), three(0, 8), 1});
    }
    const std::vector<TermAnswer> found = answers(queries);
    for (size_t i = 0; i < found.size(); ++i) {
        const TermQuery& q = queries[i];
        const glm::dvec3 exact = reference::conductor(std::max(q.x, 1e-30f), q.eta, q.k);
        for (int c = 0; c < 3; ++c) {
            // Where eta << k, the part of the root that eta leaves is a small difference.
            ASSERT_NEAR(found[i].conductor[c], exact[c], 120 * kUlp) << i;
            // docs/guide/cs184.md, "CS184 mode".
            const double cosine = q.x, eta = q.eta[c], s = eta * eta + double(q.k[c]) * q.k[c];
            const double c2 = cosine * cosine;
            const double rs = (s - 2 * eta * cosine + c2) / (s + 2 * eta * cosine + c2);
            const double rp = (s * c2 - 2 * eta * cosine + 1) / (s * c2 + 2 * eta * cosine + 1);
            ASSERT_NEAR(found[i].approximateConductor[c], (rs + rp) / 2, 20 * kUlp) << i;
        }
    }
}

TEST_F(BsdfTerms, DielectricFresnel) {
    Random random(92);
    std::vector<TermQuery> queries;
    for (int i = 0; i < 20000; ++i)
        queries.push_back({{1, 1, 1}, 1 - random.uniform(), {0, 0, 0}, random.uniform(0.4f, 2.5f)});
    const std::vector<TermAnswer> found = answers(queries);
    int total = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        const double cosine = queries[i].x, eta = queries[i].alpha;
        // Near the critical angle the root of 1 - sin^2 turns a rounding into its root.
        const double margin = std::abs(1 - eta * eta * (1 - cosine * cosine));
        if (margin < 1e-4) continue;
        const reference::Interface expected = reference::dielectric(cosine, eta);
        total += expected.total;
        ASSERT_NEAR(found[i].dielectric, expected.reflectance, 20 * kUlp / std::sqrt(margin)) << i;
        ASSERT_NEAR(found[i].cosTransmitted, expected.cosTransmitted,
                    20 * kUlp / std::sqrt(margin));
        ASSERT_EQ(found[i].cosTransmitted == 0, expected.total) << i;
    }
    EXPECT_GT(total, 1000);
}

TEST_F(BsdfTerms, DielectricFresnelAtSpecialAngles) {
    std::vector<TermQuery> queries;
    const float indices[] = {1.1f, 1.45f, 1.5f, 2.4f};
    for (const float n : indices) {
        const float brewster = float(1 / std::sqrt(1 + double(n) * n)); // cosine: tan = n
        const float critical = float(std::sqrt(1 - 1 / (double(n) * n)));
        for (const auto& [cosine, eta] : {std::pair{1.0f, 1 / n},
                                          {1.0f, n},
                                          {brewster, 1 / n},
                                          {critical * 1.0001f, n},
                                          {critical * 0.9999f, n},
                                          {1e-6f, n},
                                          {1e-20f, 1 / n}})
            queries.push_back({{1, 1, 1}, cosine, {0, 0, 0}, eta});
    }
    const std::vector<TermAnswer> found = answers(queries);
    for (size_t i = 0; i < 4; ++i) {
        const double n = indices[i], n2 = n * n;
        const TermAnswer* a = &found[7 * i];
        const double normal = std::pow((n - 1) / (n + 1), 2);
        EXPECT_NEAR(a[0].dielectric, normal, 8 * kUlp);
        EXPECT_NEAR(a[1].dielectric, normal, 8 * kUlp);
        // At Brewster's angle nothing of the one polarisation is left.
        EXPECT_NEAR(a[2].dielectric, 0.5 * std::pow((n2 - 1) / (n2 + 1), 2), 8 * kUlp);
        EXPECT_LT(a[3].dielectric, 1) << n << ": refracts just within the critical angle";
        EXPECT_GT(a[3].cosTransmitted, 0);
        for (size_t k : {4u, 5u}) {
            EXPECT_EQ(a[k].dielectric, 1) << n << ": total reflection";
            EXPECT_EQ(a[k].cosTransmitted, 0);
        }
        EXPECT_NEAR(a[6].dielectric, 1, 1e-6) << "grazing";
    }
}

TEST_F(BsdfTerms, Schlick) {
    std::vector<TermQuery> queries;
    for (int i = 0; i <= 1000; ++i)
        queries.push_back({{1, 1, 1}, float(i) * 1e-3f, {0, 0, 0}, 1.45f});
    const std::vector<TermAnswer> found = answers(queries, true);
    for (size_t i = 0; i < found.size(); ++i) {
        const double ior = 1.45f, r = (1 - ior) / (1 + ior), r0 = r * r;
        EXPECT_NEAR(found[i].schlick, r0 + (1 - r0) * std::pow(1 - double(queries[i].x), 5),
                    6 * kUlp);
    }
}

} // namespace
} // namespace stromboli::test
