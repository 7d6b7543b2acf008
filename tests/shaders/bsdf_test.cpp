// Diffuse and microfacet reflection: values against the double-precision reference, weights
// against f cos / pdf, energy, reciprocity. Mirror, refraction and glass: dielectric_test.cpp.
#include "tests/shaders/bsdf_fixture.hpp"

#include "host/reference/microfacet.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRoundoff = 0x1p-24;

const std::vector<float> kAlphas = {0.001f, 0.01f, 0.025f, 0.1f, 0.25f, 0.5f, 1.0f};

/// Material 0 is diffuse, 1 + i a conductor of roughness kAlphas[i].
std::vector<Material> reflectors() {
    std::vector<Material> materials(1 + kAlphas.size());
    materials[0].albedo = {0.8f, 0.5f, 0.02f};
    for (size_t i = 0; i < kAlphas.size(); ++i) {
        Material& m = materials[1 + i];
        m.kind = MaterialKind::Microfacet;
        m.alpha = kAlphas[i];
        m.eta = {1.3352f, 1.0109f, 0.68955f};
        m.k = {7.3398f, 6.6157f, 5.6471f};
    }
    return materials;
}

/// Relative error of f, in units of 2^-24, with the cosines of wo, wi and between wo and h. Some
/// tens of roundings; 8 in each of wo.z and wi.z, of size 1; and where D is within exp(-16), its
/// exponent tan^2 / alpha^2 carries 8 / alpha times the error of h, which is that of wo + wi, some
/// 12, over its length.
double tolerance(const Material& m, double cosO, double cosI, double cosH) {
    const double angles = 8 / cosO + 8 / cosI;
    const double lobe =
        m.kind == MaterialKind::Microfacet ? 100 + 100 / (double(m.alpha) * cosH) : 0;
    return (20 + angles + lobe) * kRoundoff;
}

class BsdfTest : public BsdfFixture, public ::testing::WithParamInterface<reference::Convention> {
  protected:
    BsdfTest() : BsdfFixture(reflectors(), GetParam()) {}
};

TEST_P(BsdfTest, ValuesAreThoseOfTheReference) {
    Random random(101);
    std::vector<gpu::BsdfQuery> queries;
    for (uint32_t i = 0; i < 40000; ++i) {
        gpu::BsdfQuery q = randomQuery(i % uint32_t(materials_.size()), random);
        const Material& m = materials_[q.material];
        if (m.kind == MaterialKind::Microfacet && i % 4) // inside the lobe
            q.wi = reflected(q, m.alpha * random.uniform(0, 3.9f), random);
        queries.push_back(q);
    }
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    int compared = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const reference::SurfacePoint s = surface(queries[i]);
        const glm::dvec3 wi(queries[i].wi);
        const double cosO = glm::dot(s.shading, s.wo), cosI = glm::dot(s.shading, wi);
        // At the edge of the hemispheres rounding decides.
        if (std::abs(cosI) < 1e-3 || std::abs(glm::dot(s.geometric, wi)) < 1e-6) continue;
        if (std::abs(cosO) < 1e-3) continue;
        const glm::dvec3 expected = reference::evaluateBsdf(s, wi, GetParam());
        const reference::Frame frame(s.shading);
        const glm::dvec3 h = glm::normalize(s.wo + wi);
        const double cosH = glm::dot(h, s.shading), tan2 = 1 / (cosH * cosH) - 1;
        const bool tail = s.material->kind == MaterialKind::Microfacet &&
                          tan2 > 16 * std::pow(double(s.material->alpha), 2);
        if (tail) continue;
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(found[i].value[c], expected[c],
                        expected[c] * tolerance(*s.material, std::abs(cosO), std::abs(cosI),
                                                glm::dot(s.wo, h)))
                << i << ' ' << s.material->alpha;
        compared += expected.x > 0;
        if (s.material->kind != MaterialKind::Microfacet || expected.x == 0) continue;
        const double density =
            reference::microfacetDensity(s.material->alpha, frame.toLocal(s.wo), frame.toLocal(wi));
        ASSERT_NEAR(found[i].density, density,
                    density *
                        tolerance(*s.material, std::abs(cosO), std::abs(cosI), glm::dot(s.wo, h)))
            << i << ' ' << s.material->alpha;
    }
    EXPECT_GT(compared, 10000);
}

/// pdf: cos / pi; D(h) cos_h / (4 wo.h).
TEST_P(BsdfTest, WeightsAreValueTimesCosineOverDensity) {
    Random random(102);
    std::vector<gpu::BsdfQuery> queries;
    for (uint32_t i = 0; i < 40000; ++i)
        queries.push_back(randomQuery(i % uint32_t(materials_.size()), random));
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    int compared = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        reference::SurfacePoint s = surface(queries[i]);
        // Of unit length in double: the half vector of two directions near the horizon turns by the
        // difference of their lengths over the cosine.
        s.wo = glm::normalize(s.wo);
        const Material& m = *s.material;
        ASSERT_NEAR(glm::length(glm::dvec3(found[i].direction)), 1, 2e-6) << i;
        const glm::dvec3 wi = glm::normalize(glm::dvec3(found[i].direction));
        const double cosO = glm::dot(s.shading, s.wo), cosI = glm::dot(s.shading, wi);
        if (cosO < 0.01 || std::abs(cosI) < 0.01 || std::abs(glm::dot(s.geometric, wi)) < 1e-5)
            continue;
        const glm::dvec3 value = reference::evaluateBsdf(s, wi, GetParam());
        const reference::Frame frame(s.shading);
        const double density =
            m.kind == MaterialKind::Diffuse
                ? cosI / kPi
                : reference::microfacetDensity(m.alpha, frame.toLocal(s.wo), frame.toLocal(wi));
        const bool zero = value == glm::dvec3(0.0);
        for (int c = 0; c < 3; ++c) {
            const double expected = zero ? 0 : value[c] / density;
            // D, whose error is the larger part of f's, is in both and drops out; the direction
            // carries the roundings of the frame, both ways.
            ASSERT_NEAR(found[i].weight[c], expected,
                        expected * (100 + 20 / cosO + 20 / cosI) * kRoundoff)
                << i << ' ' << m.alpha;
        }
        compared += !zero;
    }
    EXPECT_GT(compared, 15000);
}

INSTANTIATE_TEST_SUITE_P(Convention, BsdfTest,
                         ::testing::Values(reference::Convention::Physical,
                                           reference::Convention::Cs184),
                         [](const auto& c) {
                             return c.param == reference::Convention::Cs184 ? "Cs184" : "Physical";
                         });

class BsdfEnergy : public BsdfFixture {
  protected:
    BsdfEnergy() : BsdfFixture(whiteReflectors(), reference::Convention::Physical) {}

    /// As reflectors(), but nothing is absorbed.
    static std::vector<Material> whiteReflectors() {
        std::vector<Material> materials = reflectors();
        for (Material& m : materials) {
            m.albedo = glm::vec3(1.0f);
            m.eta = glm::vec3(1.0f);
            m.k = glm::vec3(1e6f); // a perfect conductor reflects all
        }
        return materials;
    }
};

/// White furnace: of radiance 1 from everywhere, no more than 1 is reflected: the mean weight.
TEST_F(BsdfEnergy, NoMoreIsReflectedThanArrives) {
    constexpr size_t kSamples = 20000;
    Random random(103);
    for (uint32_t material = 0; material < materials_.size(); ++material)
        for (const float cosine : {1.0f, 0.7f, 0.1f, 1e-3f, 1e-6f}) {
            std::vector<gpu::BsdfQuery> queries;
            for (size_t i = 0; i < kSamples; ++i) {
                gpu::BsdfQuery q = randomQuery(material, random);
                q.geometric = q.shading = {0, 0, 1};
                q.outside = 1;
                q.wo = {std::sqrt(1 - cosine * cosine), 0, cosine};
                queries.push_back(q);
            }
            double sum = 0, squares = 0;
            for (const gpu::BsdfAnswer& a : answers(queries)) {
                ASSERT_GE(a.weight.x, 0) << material << ' ' << cosine;
                sum += a.weight.x, squares += double(a.weight.x) * a.weight.x;
            }
            const double mean = sum / kSamples, variance = squares / kSamples - mean * mean;
            EXPECT_LE(mean, 1 + 1e-5 + 3 * std::sqrt(std::max(variance, 0.0) / kSamples))
                << material << ' ' << cosine;
            // Nor is much lost: rough conductors lose what would be reflected twice.
            const float alpha = material ? kAlphas[material - 1] : 0;
            const double least = material == 0  ? 1 - 1e-6
                                 : alpha > 0.6f ? 0.4
                                 : alpha > 0.3f ? 0.75
                                                : 0.95;
            EXPECT_TRUE(cosine < 0.5f || mean >= least) << material << ": " << mean;
        }
}

TEST_F(BsdfEnergy, Reciprocal) {
    Random random(104);
    std::vector<gpu::BsdfQuery> forth, back;
    for (uint32_t i = 0; i < 20000; ++i) {
        gpu::BsdfQuery q = randomQuery(i % uint32_t(materials_.size()), random);
        q.geometric = q.shading;
        q.outside = 1;
        if (glm::dot(q.wo, q.shading) < 0.01f) continue;
        if (q.material) q.wi = reflected(q, kAlphas[q.material - 1] * 2, random);
        if (glm::dot(q.wi, q.shading) < 0.01f) continue;
        forth.push_back(q);
        std::swap(q.wo, q.wi);
        back.push_back(q);
    }
    const std::vector<gpu::BsdfAnswer> a = answers(forth), b = answers(back);
    EXPECT_GT(forth.size(), 5000u);
    for (size_t i = 0; i < a.size(); ++i) {
        const double cosI = glm::dot(glm::dvec3(forth[i].wi), glm::dvec3(forth[i].shading));
        const double cosO = glm::dot(glm::dvec3(forth[i].wo), glm::dvec3(forth[i].shading));
        const double cosH =
            std::sqrt((1 + glm::dot(glm::dvec3(forth[i].wo), glm::dvec3(forth[i].wi))) / 2);
        const double f = a[i].value.x / cosI, g = b[i].value.x / cosO;
        ASSERT_NEAR(f, g, 2 * f * tolerance(materials_[forth[i].material], cosO, cosI, cosH)) << i;
    }
}

} // namespace
} // namespace stromboli::test
