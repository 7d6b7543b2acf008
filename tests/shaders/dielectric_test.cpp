// Mirror, refraction and glass: directions by the laws of reflection and of Snell, weights and the
// probability of reflection, under both conventions.
#include "host/cs184/cs184.hpp"
#include "tests/shaders/bsdf_fixture.hpp"

#include "host/reference/microfacet.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

std::vector<Material> deltaMaterials() {
    std::vector<Material> materials;
    for (const MaterialKind kind :
         {MaterialKind::Mirror, MaterialKind::Refraction, MaterialKind::Dielectric})
        for (const float ior : {1.1f, 1.45f, 2.4f, 0.7f}) {
            Material m;
            m.kind = kind;
            m.ior = ior;
            m.reflectance = {0.9f, 0.5f, 0.1f};
            m.transmittance = {0.2f, 0.6f, 1.0f};
            materials.push_back(m);
        }
    return materials;
}

/// What one of the two lobes should give.
struct Lobe {
    glm::dvec3 direction{0.0}, weight{0.0};
};

/// Everything docs/theory/estimator.md says of a delta material at a surface.
struct Delta {
    double reflection = 0; ///< probability
    bool total = false;
    double margin = 1; ///< distance to the critical angle, in squared cosines
    Lobe reflected, transmitted;
};

Delta expected(const reference::SurfacePoint& s, const ShadingConventions& conventions) {
    const Material& m = *s.material;
    const bool entering = conventions.facesForward ? s.outside : glm::dot(s.shading, s.wo) >= 0;
    const glm::dvec3 n = glm::dot(s.shading, s.wo) < 0 ? -s.shading : s.shading;
    const double cosine = glm::dot(n, s.wo), ior = m.ior, eta = entering ? 1 / ior : ior;
    Delta d;
    d.reflected = {2 * cosine * n - s.wo, m.reflectance};
    if (m.kind == MaterialKind::Mirror) {
        d.reflection = 1;
        return d;
    }
    const double sine2 = eta * eta * (1 - cosine * cosine);
    d.margin = std::abs(1 - sine2);
    d.total = sine2 >= 1;
    double share = 0; // of light that is reflected
    if (m.kind == MaterialKind::Dielectric) {
        const double exact = reference::dielectric(cosine, eta).reflectance;
        const bool schlick = !conventions.exactFresnel && !d.total;
        share = schlick ? reference::schlick(cosine, ior) : exact;
        // Samples are reflected in proportion to what is.
        const double r = share * reference::mean(m.reflectance),
                     t = (1 - share) * reference::mean(m.transmittance);
        d.reflection = r / (r + t);
        d.reflected.weight = glm::dvec3(m.reflectance) * (share / d.reflection);
    }
    if (d.total) return d;
    // Snell: the part across n grows by eta, the rest follows.
    d.transmitted.direction = -eta * (s.wo - cosine * n) - std::sqrt(1 - sine2) * n;
    const double compression = conventions.compressesRadiance ? eta * eta : 1 / (eta * eta);
    d.transmitted.weight =
        glm::dvec3(m.transmittance) * (compression * (1 - share) / (1 - d.reflection));
    return d;
}

class DielectricTest : public BsdfFixture,
                       public ::testing::WithParamInterface<ShadingConventions> {
  protected:
    DielectricTest() : BsdfFixture(deltaMaterials(), GetParam()) {}

    void expectLobe(const gpu::BsdfAnswer& a, const Lobe& lobe, bool transmitted,
                    const reference::SurfacePoint& s, double tolerance, size_t i) {
        EXPECT_EQ(((a.lobe & gpu::TRANSMISSION_LOBES) != 0), transmitted) << i;
        EXPECT_LT(glm::length(glm::dvec3(a.direction) - lobe.direction), tolerance) << i;
        EXPECT_NEAR(glm::length(glm::dvec3(a.direction)), 1, tolerance) << i;
        // Light stays on the side of the true surface it was sent to.
        const double side = glm::dot(s.geometric, lobe.direction) * (transmitted ? -1 : 1);
        if (GetParam().testsGeometricSide && std::abs(side) < 1e-5) return;
        const bool leaks = GetParam().testsGeometricSide && side < 0;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(a.weight[c], leaks ? 0 : lobe.weight[c], 4e-6 * lobe.weight[c]) << i;
        leaks_ += leaks;
    }

    int leaks_ = 0;
};

TEST_P(DielectricTest, DirectionsAndWeights) {
    Random random(111);
    std::vector<gpu::BsdfQuery> queries;
    for (uint32_t i = 0; i < 40000; ++i)
        queries.push_back(randomQuery(i % uint32_t(materials_.size()), random));
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    int reflected = 0, transmitted = 0, total = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        EXPECT_EQ(found[i].value, glm::vec3(0.0f)) << "delta: never found by light samples";
        const reference::SurfacePoint s = surface(queries[i]);
        const Delta d = expected(s, GetParam());
        const double tolerance = 1e-6 / std::sqrt(d.margin);
        if (d.margin < 1e-4 || std::abs(queries[i].w - d.reflection) < 1e-5) continue;
        if (queries[i].w < d.reflection) {
            ++reflected;
            total += d.total;
            expectLobe(found[i], d.reflected, false, s, tolerance, i);
        } else if (d.total) { // Refraction without Fresnel reflection: black
            EXPECT_EQ(found[i].weight, glm::vec3(0.0f)) << i;
        } else {
            ++transmitted;
            expectLobe(found[i], d.transmitted, true, s, 8 * tolerance, i);
        }
    }
    EXPECT_GT(reflected, 10000);
    EXPECT_GT(transmitted, 10000);
    EXPECT_GT(total, 200);
    EXPECT_TRUE(leaks_ > 50 || !GetParam().testsGeometricSide);
}

/// The choice changes from reflection to transmission where u passes the reflectance.
TEST_P(DielectricTest, ReflectionHasTheProbabilityOfFresnel) {
    Random random(112);
    std::vector<gpu::BsdfQuery> queries;
    std::vector<bool> reflects;
    for (uint32_t i = 0; i < 8000; ++i) {
        gpu::BsdfQuery q = randomQuery(8 + i % 4, random); // Glass
        const Delta d = expected(surface(q), GetParam());
        if (d.margin < 1e-4 || d.reflection < 1e-3 || d.reflection > 1 - 1e-3) continue;
        const double step = 1e-6 / std::sqrt(d.margin);
        for (const double sign : {-1.0, 1.0}) {
            q.w = float(d.reflection + sign * step);
            queries.push_back(q);
            reflects.push_back(sign < 0);
        }
    }
    EXPECT_GT(queries.size(), 8000u);
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i)
        ASSERT_EQ((found[i].lobe & gpu::TRANSMISSION_LOBES) == 0, reflects[i]) << i;
}

/// In and out again multiplies radiance by the transmittance squared, not by any index.
TEST_P(DielectricTest, RadianceFactorsOfBothSidesCancel) {
    for (uint32_t material = 4; material < 12; ++material) {
        gpu::BsdfQuery q{};
        q.material = material;
        q.geometric = q.shading = {0, 0, 1};
        q.w = 0.999f;
        q.wo = {0, 0, 1};
        q.outside = 1;
        gpu::BsdfQuery out = q;
        out.wo = {0, 0, -1};
        out.outside = 0;
        const std::vector<gpu::BsdfAnswer> found = answers({q, out});
        const glm::vec3 product = found[0].weight * found[1].weight;
        const Material& m = materials_[material];
        const glm::vec3 t = m.transmittance;
        // Both choices of a side were of these probabilities; along the normal Schlick is exact.
        const double r = std::pow((m.ior - 1) / (m.ior + 1), 2);
        const double passed = (1 - r) * reference::mean(t);
        const bool reflects = m.kind == MaterialKind::Dielectric;
        const double chosen = reflects ? passed / (passed + r * reference::mean(m.reflectance)) : 1;
        const double factor = std::pow((reflects ? 1 - r : 1) / chosen, 2);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(product[c], t[c] * t[c] * factor, 2e-6) << material;
    }
}

INSTANTIATE_TEST_SUITE_P(Convention, DielectricTest,
                         ::testing::Values(ShadingConventions{}, cs184Shading()),
                         [](const auto& c) {
                             return c.param == cs184Shading() ? "Cs184" : "Physical";
                         });

} // namespace
} // namespace stromboli::test
