// The BSDF contract, on every material of bsdf_cases.hpp: values and densities are the
// double-precision reference's, weights are value over density, samples fall where the density
// says, light is neither gained nor lost where it should not be. What is special to interfaces:
// dielectric_test.cpp.
#include "host/cs184/cs184.hpp"
#include "tests/shaders/bsdf_cases.hpp"
#include "tests/shaders/bsdf_fixture.hpp"
#include "tests/support/chi_square.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

/// Relative error of f, in units of 2^-24, with the cosines of wo, wi and between wo and h. Some
/// tens of roundings; 8 in each of wo.z and wi.z, of size 1; and where D is within exp(-16), its
/// exponent tan^2 / alpha^2 carries 8 / alpha times the error of h, which is that of wo + wi, some
/// 12, over its length.
double tolerance(const BsdfCase& c, double cosO, double cosI, double cosH) {
    const double angles = 8 / cosO + 8 / cosI;
    const double lobe = c.lobe > 0 ? 100 + 100 / (c.lobe * cosH) : 0;
    return (20 + angles + lobe) * kRoundoff + c.error;
}

bool isVolume(const Material& m) {
    if (m.kind == MaterialKind::Dielectric) return true;
    if (m.kind == MaterialKind::Burley) return m.burley.transmission > 0 && !m.burley.isThin;
    return m.kind == MaterialKind::Principled && m.principled.transmission > 0 &&
           !m.principled.isThin;
}

/// Index on the side of wo over that on the other, of a channel: 0 is red.
double indexRatio(const reference::SurfacePoint& s, const ShadingConventions& conventions,
                  int channel = 1) {
    const MaterialKind kind = s.material->kind;
    const double stated = kind == MaterialKind::Principled ? s.material->principled.ior
                          : kind == MaterialKind::Burley   ? s.material->burley.ior
                                                           : s.material->ior;
    double ior = stated == 1 ? 1 + double(gpu::LEAST_INDEX_STEP) : stated;
    if (kind == MaterialKind::Principled && s.material->principled.dispersion > 0)
        ior = std::max(ior + double(s.material->principled.indexSpread()) * (channel - 1),
                       1 + double(gpu::LEAST_INDEX_STEP));
    const bool enters = conventions.facesForward ? s.outside : glm::dot(s.shading, s.wo) >= 0;
    return enters ? 1 / ior : ior;
}

/// The normal of the facets that send light from wi to wo.
glm::dvec3 halfVector(const reference::SurfacePoint& s, const glm::dvec3& wi,
                      const ShadingConventions& conventions, int channel = 1) {
    const double cosI = glm::dot(s.shading, wi);
    const bool isPrincipled =
        s.material->kind == MaterialKind::Principled || s.material->kind == MaterialKind::Burley;
    if (cosI > 0 || !(isPrincipled || isVolume(*s.material))) return glm::normalize(s.wo + wi);
    if (!isVolume(*s.material)) return glm::normalize(s.wo + wi - 2 * cosI * s.shading);
    const glm::dvec3 h = indexRatio(s, conventions, channel) * s.wo + wi;
    return glm::dot(h, h) == 0 ? s.shading : glm::normalize(glm::dot(h, s.shading) < 0 ? -h : h);
}

/// The facet is about to reflect everything: its reflectance goes there like a square root, which
/// turns a rounding into its root.
bool isCritical(const reference::SurfacePoint& s, const glm::dvec3& wi,
                const ShadingConventions& conventions) {
    for (int channel = 0; channel < 3 && isVolume(*s.material); ++channel) {
        const double eta = indexRatio(s, conventions, channel);
        const double cosine = glm::dot(s.wo, halfVector(s, wi, conventions, channel));
        if (std::abs(1 - eta * eta * (1 - cosine * cosine)) < 0.03) return true;
    }
    return false;
}

/// By channel, whether the half vector is not far down the tail of the lobe.
glm::bvec3 isInLobe(const BsdfCase& c, const reference::SurfacePoint& s, const glm::dvec3& wi,
                    const ShadingConventions& conventions) {
    glm::bvec3 is(true);
    for (int channel = 0; channel < 3 && c.lobe > 0; ++channel) {
        const double cosH = glm::dot(halfVector(s, wi, conventions, channel), s.shading);
        is[channel] = !(1 / (cosH * cosH) - 1 > 16 * c.lobe * c.lobe);
    }
    return is;
}

/// The side of the plane over the base of plastic, which either direction may meet.
bool isCriticalOfPlastic(const reference::SurfacePoint& s, const glm::dvec3& wi) {
    const double eta = 1 / double(s.material->ior);
    const auto isNear = [&](double cosine) {
        return std::abs(1 - eta * eta * (1 - cosine * cosine)) < 0.03;
    };
    return s.material->kind == MaterialKind::Plastic &&
           (isNear(glm::dot(s.shading, s.wo)) || isNear(glm::dot(s.shading, wi)));
}

/// Of each material, for what is compared with the reference in each.
constexpr size_t kDirections = 3000;

class BsdfTest : public BsdfFixture, public ::testing::WithParamInterface<ShadingConventions> {
  protected:
    BsdfTest() : BsdfFixture(materialsOf(bsdfCases()), GetParam()) {}

    /// A query whose wi is likely to be in the lobe.
    gpu::BsdfQuery queryInLobe(uint32_t i, Random& random) const {
        const auto material = i % uint32_t(cases_.size());
        gpu::BsdfQuery q = randomQuery(material, random);
        const auto lobe = float(cases_[material].lobe);
        if (lobe > 0 && i / cases_.size() % 4 != 0)
            q.wi = reflected(q, lobe * random.uniform(0, 3.9f), random);
        if (reference::isLitFromBehind(cases_[material].material) && i / cases_.size() % 2 != 0)
            q.wi = transmitted(q, lobe * random.uniform(0, 3.9f), random);
        return q;
    }

    /// wi such that a half vector at this tangent to the normal sends it through the surface to wo.
    glm::vec3 transmitted(const gpu::BsdfQuery& q, float tangent, Random& random) const {
        const glm::vec3 mirrored = reflected(q, tangent, random);
        const reference::SurfacePoint s = surface(q);
        const glm::dvec3 h = glm::normalize(s.wo + glm::dvec3(mirrored));
        if (!isVolume(*s.material))
            return glm::dvec3(mirrored) - 2 * glm::dot(glm::dvec3(mirrored), s.shading) * s.shading;
        const double eta = indexRatio(s, GetParam()), cosine = glm::dot(s.wo, h);
        const double cos2 = 1 - eta * eta * (1 - cosine * cosine);
        if (!(cos2 > 0)) return mirrored;
        return glm::normalize((eta * cosine - std::sqrt(cos2)) * h - eta * s.wo);
    }

    std::vector<BsdfCase> cases_ = bsdfCases();
};

TEST_P(BsdfTest, ValuesAndDensitiesAreThoseOfTheReference) {
    Random random(101);
    std::vector<gpu::BsdfQuery> queries;
    for (uint32_t i = 0; i < kDirections * cases_.size(); ++i)
        queries.push_back(queryInLobe(i, random));
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    std::vector<int> compared(cases_.size(), 0);
    for (size_t i = 0; i < queries.size(); ++i) {
        const BsdfCase& c = cases_[queries[i].material];
        const reference::SurfacePoint s = surface(queries[i]);
        if (!reference::scattersIntoManyDirections(reference::lobesOf(*s.material))) {
            ASSERT_EQ(found[i].value, glm::vec3(0.0f)) << c.name << ": delta lobes are never found";
            continue;
        }
        const glm::dvec3 wi(queries[i].wi);
        const double cosO = glm::dot(s.shading, s.wo), cosI = glm::dot(s.shading, wi);
        // At the edge of the hemispheres rounding decides.
        if (std::abs(cosI) < 1e-3 || std::abs(glm::dot(s.geometric, wi)) < 1e-6) continue;
        if (std::abs(cosO) < 1e-3) continue;
        const reference::BsdfValue expected = reference::evaluateBsdf(s, wi, GetParam());
        const glm::dvec3 h = halfVector(s, wi, GetParam());
        if (isCritical(s, wi, GetParam()) || isCriticalOfPlastic(s, wi)) continue;
        const glm::bvec3 inLobe = isInLobe(c, s, wi, GetParam());
        if (!glm::any(inLobe)) continue;
        const double relative =
            tolerance(c, std::abs(cosO), std::abs(cosI), std::abs(glm::dot(s.wo, h)));
        for (int k = 0; k < 3; ++k)
            if (inLobe[k]) {
                ASSERT_NEAR(found[i].value[k], expected.value[k], expected.value[k] * relative)
                    << c.name << ' ' << i;
            }
        const bool isZero = expected.value == glm::dvec3(0.0);
        compared[queries[i].material] += !isZero;
        if (isZero) continue;
        ASSERT_NEAR(found[i].pdf, expected.pdf, expected.pdf * relative) << c.name << ' ' << i;
    }
    for (size_t m = 0; m < cases_.size(); ++m)
        EXPECT_TRUE(compared[m] > 240 ||
                    !reference::scattersIntoManyDirections(reference::lobesOf(cases_[m].material)))
            << cases_[m].name << ' ' << compared[m];
}

TEST_P(BsdfTest, WeightsAreValuesOverDensities) {
    Random random(102);
    std::vector<gpu::BsdfQuery> queries;
    for (uint32_t i = 0; i < kDirections * cases_.size(); ++i)
        queries.push_back(randomQuery(i % uint32_t(cases_.size()), random));
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    int compared = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const BsdfCase& c = cases_[queries[i].material];
        reference::SurfacePoint s = surface(queries[i]);
        // The directions have unit length in double: the half vector of two directions near the
        // horizon turns by the difference of their lengths over the cosine.
        s.wo = glm::normalize(s.wo);
        const uint32_t lobes = reference::lobesOf(*s.material);
        const bool black = found[i].weight == glm::vec3(0.0f);
        ASSERT_TRUE(black || (found[i].lobe & lobes) != 0) << c.name << ": not a lobe of its own";
        if (found[i].lobe & gpu::DELTA_LOBES || !reference::scattersIntoManyDirections(lobes))
            continue;
        ASSERT_NEAR(glm::length(glm::dvec3(found[i].direction)), 1, 2e-6) << c.name << ' ' << i;
        const glm::dvec3 wi = glm::normalize(glm::dvec3(found[i].direction));
        const double cosO = glm::dot(s.shading, s.wo), cosI = glm::dot(s.shading, wi);
        if (cosO < 0.01 || std::abs(cosI) < 0.01 || std::abs(glm::dot(s.geometric, wi)) < 1e-5)
            continue;
        // Reflected below the surface, where light is transmitted.
        if (black && ((found[i].lobe & gpu::TRANSMISSION_LOBES) != 0) != (cosI < 0)) continue;
        const glm::dvec3 h = halfVector(s, wi, GetParam());
        if (isCritical(s, wi, GetParam()) || isCriticalOfPlastic(s, wi)) continue;
        const glm::bvec3 isNear = isInLobe(c, s, wi, GetParam());
        const reference::BsdfValue expected = reference::evaluateBsdf(s, wi, GetParam());
        const bool zero = expected.value == glm::dvec3(0.0);
        const double inLobe = tolerance(c, cosO, std::abs(cosI), std::abs(glm::dot(s.wo, h)));
        // D, whose error is the larger part of f's, is in both and drops out; the direction carries
        // the roundings of the frame, both ways.
        double relative = (100 + 20 / cosO + 20 / std::abs(cosI)) * kRoundoff;
        // If there are several lobes it does not.
        if (c.error > 0) relative += inLobe;
        const bool disperses = s.material->principled.dispersion > 0;
        for (int k = 0; k < 3; ++k) {
            // A colour that goes elsewhere has but the tail of its lobe here.
            if (disperses && !isNear[k]) continue;
            const double weight = zero ? 0 : expected.value[k] / expected.pdf;
            ASSERT_NEAR(found[i].weight[k], weight, weight * relative) << c.name << ' ' << i;
        }
        if (zero) continue;
        ++compared;
        if (!glm::any(isNear)) continue;
        ASSERT_NEAR(found[i].samplePdf, expected.pdf, expected.pdf * (inLobe + relative))
            << c.name << ' ' << i;
    }
    EXPECT_GT(compared, 7200);
}

INSTANTIATE_TEST_SUITE_P(Convention, BsdfTest,
                         ::testing::Values(ShadingConventions{}, cs184Shading()),
                         [](const auto& c) {
                             return c.param == cs184Shading() ? "Cs184" : "Physical";
                         });

bool isWithoutGrain(const Material& m) {
    return m.facets.alpha.x == m.facets.alpha.y && m.principled.anisotropy == 0 &&
           m.burley.anisotropy == 0;
}

/// One case at a time, under the physical convention.
class BsdfCases : public BsdfFixture, public ::testing::WithParamInterface<size_t> {
  protected:
    BsdfCases()
        : BsdfFixture({bsdfCases()[GetParam()].material, bsdfCases()[GetParam()].white}, {}) {}
    static constexpr uint32_t kMaterial = 0, kWhite = 1;

    gpu::BsdfQuery facing(uint32_t material, float cosine, Random& random) const {
        gpu::BsdfQuery q = randomQuery(material, random);
        q.geometric = q.shading = {0, 0, 1};
        q.outside = 1;
        q.wo = {std::sqrt(1 - cosine * cosine), 0, cosine};
        return q;
    }
    bool scattersWidely() const {
        return reference::scattersIntoManyDirections(reference::lobesOf(case_.material));
    }

    BsdfCase case_ = bsdfCases()[GetParam()];
};

/// Point i of Gauss's rule, with four points at a time: where it is, and what it weighs, in units
/// of the distance between points that lie evenly.
struct GaussPoint {
    double at, weight;

    explicit GaussPoint(size_t i) {
        constexpr double kInner = 0.339981043584856265, kOuter = 0.861136311594052575,
                         kInnerWeight = 0.652145154862546143;
        const size_t k = i % 4;
        const bool isInner = k == 1 || k == 2;
        const double x = (isInner ? kInner : kOuter) * (k < 2 ? -1 : 1);
        at = double(i - k) + 2 + 2 * x;
        weight = 2 * (isInner ? kInnerWeight : 1 - kInnerWeight);
    }
};

/// Samples in cells of the hemisphere that are equal in z and azimuth, against the integral of the
/// reference's density over the cell; those that are lost, or of a delta lobe, are one more cell.
/// .01 for all cases together.
TEST_P(BsdfCases, SamplesFallWhereTheDensitySays) {
    if (!scattersWidely() || !case_.smooth) GTEST_SKIP() << "delta lobes, or too narrow for cells";
    constexpr size_t kSamples = 100000, kRings = 12, kSectors = 16;
    Random random(105);
    const bool transmits = reference::isLitFromBehind(case_.material);
    // Refracted lobes are narrow, and about a pole.
    const size_t perCell = transmits ? 32 : 8;
    for (const float cosine : {0.95f, 0.4f}) {
        std::vector<gpu::BsdfQuery> queries;
        for (size_t i = 0; i < kSamples; ++i)
            queries.push_back(facing(kMaterial, cosine, random));
        std::vector<double> counts(kRings * kSectors + 1, 0), expected(counts.size(), 0);
        for (const gpu::BsdfAnswer& a : answers(queries)) {
            const glm::dvec3 w(a.direction);
            const double turn = std::atan2(w.y, w.x) / (2 * kPi) + 0.5;
            const double height = transmits ? (w.z + 1) / 2 : std::max(w.z, 0.0);
            const auto ring = std::min(size_t(height * kRings), kRings - 1);
            const auto sector = std::min(size_t(turn * kSectors), kSectors - 1);
            const bool isLost = a.weight == glm::vec3(0) || (a.lobe & gpu::DELTA_LOBES) != 0;
            ++counts[!isLost ? ring * kSectors + sector : kRings * kSectors];
        }
        const reference::SurfacePoint s = surface(queries[0]);
        double sum = 0;
        // wo is in the plane y = 0: without a grain the density is the same on both sides of it.
        const size_t directions = kSectors * perCell,
                     sides = isWithoutGrain(case_.material) ? 2 : 1;
        for (size_t i = 0; i < kRings * perCell; ++i)
            for (size_t j = 0; j < directions / sides; ++j) {
                const GaussPoint row(i), column(j);
                const double height = row.at / double(kRings * perCell);
                const double z = transmits ? 2 * height - 1 : height;
                const double phi = 2 * kPi * (column.at / double(directions) - 0.5);
                const double r = std::sqrt(1 - z * z);
                const glm::dvec3 w(r * std::cos(phi), r * std::sin(phi), z);
                const double share = reference::evaluateBsdf(s, w, {}).pdf * (transmits ? 4 : 2) *
                                     kPi * row.weight * column.weight /
                                     double(kRings * perCell * directions);
                for (size_t side = 0; side < sides; ++side) {
                    const size_t k = side == 0 ? j : directions - 1 - j;
                    expected[i / perCell * kSectors + k / perCell] += share * kSamples;
                    sum += share;
                }
            }
        constexpr double kQuadrature = 3e-5; // of the sum
        expected.back() = std::max(1 - sum, kQuadrature) * kSamples;
        EXPECT_GT(chiSquareTest(counts, expected), sidakLevel(0.01, 2 * bsdfCases().size()))
            << cosine;
    }
}

/// White furnace: of radiance 1 from everywhere, no more than 1 is reflected, down to grazing
/// views; and what a perfect surface should keep it keeps.
TEST_P(BsdfCases, NoLightIsGainedAndLittleIsLost) {
    constexpr size_t kSamples = 20000;
    // 3.6 sigma: .01 for the five views of all cases together.
    Random random(103 + uint32_t(GetParam()));
    for (const float cosine : {1.0f, 0.7f, 0.1f, 1e-3f, 1e-6f}) {
        std::vector<gpu::BsdfQuery> queries;
        for (size_t i = 0; i < kSamples; ++i)
            queries.push_back(facing(kWhite, cosine, random));
        double sum = 0, squares = 0;
        for (const gpu::BsdfAnswer& a : answers(queries)) {
            ASSERT_TRUE(std::isfinite(a.weight.x) && a.weight.x >= 0) << cosine;
            sum += a.weight.x, squares += double(a.weight.x) * a.weight.x;
        }
        const double mean = sum / kSamples, variance = squares / kSamples - mean * mean;
        const double noise = 3.6 * std::sqrt(std::max(variance, 0.0) / kSamples);
        EXPECT_LE(mean, 1 + 1e-5 + case_.gain + noise) << cosine;
        if (cosine >= 0.5f) {
            EXPECT_GE(mean, case_.leastWhite - noise) << cosine;
        }
        EXPECT_GE(mean, case_.leastGrazing - noise) << cosine;
    }
}

TEST_P(BsdfCases, Reciprocal) {
    if (!case_.reciprocal) GTEST_SKIP() << "what is given back depends on wo alone";
    if (!scattersWidely()) GTEST_SKIP() << "delta lobes";
    Random random(104);
    std::vector<gpu::BsdfQuery> forth, back;
    for (uint32_t i = 0; i < 8000; ++i) {
        gpu::BsdfQuery q = randomQuery(kMaterial, random);
        q.geometric = q.shading;
        q.outside = 1;
        if (glm::dot(q.wo, q.shading) < 0.01f) continue;
        if (case_.lobe > 0) q.wi = reflected(q, float(case_.lobe) * 2, random);
        if (glm::dot(q.wi, q.shading) < 0.01f) continue;
        forth.push_back(q);
        std::swap(q.wo, q.wi);
        back.push_back(q);
    }
    const std::vector<gpu::BsdfAnswer> a = answers(forth), b = answers(back);
    EXPECT_GT(forth.size(), 1000u);
    for (size_t i = 0; i < a.size(); ++i) {
        const glm::dvec3 wo(forth[i].wo), wi(forth[i].wi), n(forth[i].shading);
        const double cosI = glm::dot(wi, n), cosO = glm::dot(wo, n);
        const double f = a[i].value.x / cosI, g = b[i].value.x / cosO;
        const double cosH = std::sqrt((1 + glm::dot(wo, wi)) / 2);
        ASSERT_NEAR(f, g, 2 * f * tolerance(case_, cosO, cosI, cosH)) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(All, BsdfCases, ::testing::Range<size_t>(0, bsdfCases().size()),
                         [](const auto& c) { return bsdfCases()[c.param].name; });

} // namespace
} // namespace stromboli::test
