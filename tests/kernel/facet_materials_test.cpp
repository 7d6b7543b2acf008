// Conductors, rough and thin dielectrics and plastic as the kernel gets them: which closures
// they are, and the numbers that plastic is made of.
#include "host/kernel/facet_terms.hpp"
#include "host/kernel/material_rows.hpp"
#include "shaders/shared/parameters.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

Material ofKind(MaterialKind kind, float alphaX, float alphaY, float ior = 1.5f) {
    Material m;
    m.kind = kind;
    m.ior = ior;
    m.facets.alpha = {alphaX, alphaY};
    return m;
}

TEST(FacetMaterials, AreSmoothWhereFloatsCannotTell) {
    using enum MaterialKind;
    const auto isSmooth = [](const Material& m) {
        const uint32_t bits = closureBits(m);
        EXPECT_TRUE(bits & gpu::CLOSURE_INTERFACE);
        const bool smooth = bits & gpu::INTERFACE_IS_SMOOTH;
        EXPECT_EQ(bool(bits & gpu::DELTA_LOBES), smooth);
        EXPECT_EQ(bool(bits & gpu::GLOSSY_LOBES), !smooth);
        return smooth;
    };
    EXPECT_TRUE(isSmooth(ofKind(Conductor, 0, 0)));
    EXPECT_TRUE(isSmooth(ofKind(Conductor, 0.99e-4f, 0)));
    EXPECT_FALSE(isSmooth(ofKind(Conductor, 1e-4f, 0)));
    EXPECT_FALSE(isSmooth(ofKind(Conductor, 0, 0.3f)));
    EXPECT_EQ(ofKind(Conductor, 0, 0.3f).facetAlpha(), glm::vec2(1e-4f, 0.3f));
    EXPECT_TRUE(isSmooth(ofKind(Dielectric, 0, 0)));
    EXPECT_FALSE(isSmooth(ofKind(Dielectric, 0.1f, 0.1f)));
    EXPECT_TRUE(isSmooth(ofKind(Dielectric, 0.1f, 0.1f, 1))) << "no interface";
    EXPECT_TRUE(isSmooth(ofKind(Dielectric, 0.02f, 0.02f, 1 + 0x1p-10f)));
    EXPECT_FALSE(isSmooth(ofKind(Dielectric, 0.04f, 0.04f, 1 + 0x1p-10f)));
    EXPECT_TRUE(isSmooth(ofKind(ThinDielectric, 0.1f, 0.1f)));
    EXPECT_TRUE(isSmooth(ofKind(Plastic, 0, 1))) << "the first alpha counts";
    EXPECT_FALSE(isSmooth(ofKind(Plastic, 0.1f, 0)));
    EXPECT_TRUE(ofKind(Dielectric, 0, 0).isDelta());
    EXPECT_FALSE(ofKind(Plastic, 0, 0).isDelta());
}

TEST(FacetMaterials, SayWhichClosuresTheyHave) {
    using enum MaterialKind;
    Material beckmann = ofKind(Conductor, 0.3f, 0.3f);
    beckmann.facets.distribution = FacetDistribution::Beckmann;
    beckmann.facets.masking = FacetMasking::Separable;
    EXPECT_EQ(closureBits(beckmann), gpu::CLOSURE_INTERFACE | gpu::INTERFACE_IS_CONDUCTOR |
                                         gpu::FACETS_BITS | gpu::LOBE_GLOSSY_REFLECTION |
                                         gpu::HAS_BASE_COLOR);
    EXPECT_EQ(closureBits(ofKind(Diffuse, 0, 0)),
              gpu::CLOSURE_BASE | gpu::LOBE_DIFFUSE_REFLECTION | gpu::HAS_BASE_COLOR);
    const uint32_t plastic = closureBits(ofKind(Plastic, 0.1f, 0.1f));
    EXPECT_TRUE(plastic & gpu::CLOSURE_LAYERS);
    EXPECT_FALSE(plastic & (gpu::INTERFACE_REFRACTS | gpu::FACETS_BITS));
}

/// What a material lacks is no vote on how those are that have it.
TEST(SceneClosures, AreThoseOfSomeMaterialAndOfAllThatTheyConcern) {
    using enum MaterialKind;
    SceneClosures scene;
    scene.add(closureBits(ofKind(Diffuse, 0, 0)));
    scene.add(closureBits(ofKind(Conductor, 0, 0)));
    EXPECT_EQ(scene.some & scene.all & ~gpu::HAS_BASE_COLOR,
              gpu::INTERFACE_IS_SMOOTH | gpu::INTERFACE_IS_CONDUCTOR);
    Material beckmann = ofKind(Conductor, 0.3f, 0.3f);
    beckmann.facets.distribution = FacetDistribution::Beckmann;
    scene.add(closureBits(beckmann));
    EXPECT_FALSE(scene.all & gpu::INTERFACE_IS_SMOOTH);
    EXPECT_TRUE(scene.all & gpu::FACETS_ARE_BECKMANN) << "planes have no facets";
    scene.add(closureBits(ofKind(Conductor, 0.3f, 0.3f)));
    EXPECT_FALSE(scene.all & gpu::FACETS_ARE_BECKMANN);
    EXPECT_TRUE(scene.some & gpu::FACETS_ARE_BECKMANN);
}

TEST(FacetMaterials, HaveAGrainWhereTheirAlphasDiffer) {
    EXPECT_FALSE(ofKind(MaterialKind::Conductor, 0.3f, 0.3f).hasGrain());
    EXPECT_TRUE(ofKind(MaterialKind::Conductor, 0.3f, 0.2f).hasGrain());
    EXPECT_FALSE(ofKind(MaterialKind::Conductor, 1e-5f, 2e-5f).hasGrain());
    EXPECT_FALSE(ofKind(MaterialKind::Plastic, 0.3f, 0.2f).hasGrain());
    Material m = ofKind(MaterialKind::Dielectric, 0.3f, 0.3f);
    m.textures = {{.slot = TextureSlot::MetallicRoughness}};
    EXPECT_TRUE(m.hasGrain());
}

double fresnel(double cosine, double eta) {
    const double t2 = 1 - eta * eta * (1 - cosine * cosine), t = std::sqrt(std::max(t2, 0.0));
    if (t2 <= 0) return 1;
    const double s = (eta * cosine - t) / (eta * cosine + t);
    const double p = (cosine - eta * t) / (cosine + eta * t);
    return (s * s + p * p) / 2;
}

TEST(FacetTerms, AreaOfBeckmannsFacetsIsThatOfItsFormula) {
    for (double a = 0; a < 8; a += 0.00037) {
        const double bell = std::exp(-a * a) / std::sqrt(3.14159265358979323846);
        ASSERT_NEAR(beckmannArea(a), (a * (1 + std::erf(a)) + bell) / 2, 3e-9) << a;
    }
    EXPECT_EQ(beckmannArea(1e30), 1e30);
}

TEST(InterfaceTable, InternalReflectanceIsTheMeanOfFresnels) {
    EXPECT_NEAR(internalReflectance(1.5), 0.5963, 1e-4); // Duntley 1942
    EXPECT_EQ(internalReflectance(1), 0);
    for (const double ior : {0.5, 0.7, 0.999, 1.001, 1.1, 1.33, 1.5, 2.4, 4.0}) {
        constexpr int kViews = 400000;
        double sum = 0;
        for (int i = 0; i < kViews; ++i) {
            const double mu = (i + 0.5) / kViews;
            sum += 2 * mu * fresnel(mu, ior) / kViews;
        }
        EXPECT_NEAR(internalReflectance(ior), sum, 1e-6) << ior;
    }
}

/// Tables take a millisecond each, and rooms have dozens of varnished things.
TEST(InterfaceTable, IsSharedByMaterialsThatAreAlike) {
    constexpr MaterialKind kPlastic = MaterialKind::Plastic;
    const std::vector<Material> alike = {ofKind(kPlastic, 0.1f, 0.1f),
                                         ofKind(kPlastic, 0.1f, 0.1f)},
                                others = {ofKind(kPlastic, 0.1f, 0.1f),
                                          ofKind(kPlastic, 0.3f, 0.3f)};
    const auto tableOf = [](const MaterialRows& rows, size_t material) {
        return rows.rows[rows.firstRow[material] + gpu::STATED_TABLE_ROW][3];
    };
    const MaterialRows one = packMaterials(alike), two = packMaterials(others);
    EXPECT_EQ(tableOf(one, 0), tableOf(one, 1));
    EXPECT_EQ(one.rows.size(), tableOf(one, 0) + gpu::TRANSMITTANCE_PIECES);
    EXPECT_EQ(tableOf(two, 1), tableOf(two, 0) + gpu::TRANSMITTANCE_PIECES);
}

/// Facets that are nearly a plane let through what a plane does, but along it, where their slopes
/// matter.
TEST(InterfaceTable, HasTheLimitOfAPlane) {
    for (const FacetDistribution d : {FacetDistribution::Ggx, FacetDistribution::Beckmann}) {
        EXPECT_NEAR(internalReflectance(1.5, 1e-4, {.distribution = d}), internalReflectance(1.5),
                    5e-4);
        const auto table = transmittanceTable(1.5, 1e-4, {.distribution = d});
        for (int i = 32; i <= 1000; ++i) { // views of cosines above 10 alpha
            const double place = i / 1000.0 * table.size();
            const size_t piece = std::min(size_t(place), table.size() - 1);
            const double x = place - double(piece), root = i / 1000.0;
            const glm::dvec4 c(table[piece]);
            EXPECT_NEAR(c.x + x * (c.y + x * (c.z + x * c.w)), 1 - fresnel(root * root, 1 / 1.5),
                        5e-4)
                << root;
        }
    }
}

/// The share of light from a direction that GGX's facets let through, by all normals: those of the
/// distribution that are seen, with 1 - F and Smith's masking of both directions, heights being
/// correlated. mu: the direction's cosine.
double transmittedByFacets(double ior, double alpha, double mu) {
    const auto lambda = [&](double z) {
        return (std::sqrt(1 + alpha * alpha * (1 / (z * z) - 1)) - 1) / 2;
    };
    constexpr int kCosines = 1500, kAzimuths = 500;
    const double sine = std::sqrt(1 - mu * mu), eta = 1 / ior;
    double sum = 0;
    for (int i = 0; i < kCosines; ++i) {
        const double z = (i + 0.5) / kCosines, a2 = alpha * alpha;
        const double density = a2 / (M_PI * std::pow(z * z * (a2 - 1) + 1, 2));
        for (int j = 0; j < kAzimuths; ++j) {
            const double across = std::sqrt(1 - z * z) * std::cos(M_PI * (j + 0.5) / kAzimuths);
            const double c = sine * across + mu * z;
            if (c <= 0) continue;
            const double t = std::sqrt(1 - eta * eta * (1 - c * c));
            const double other = (eta * c - t) * z - eta * mu; // of the direction below
            if (other >= 0) continue;
            const double masking = 1 / (1 + lambda(mu) + lambda(-other));
            sum += density * c / mu * (1 - fresnel(c, eta)) * masking;
        }
    }
    return sum * 2 * M_PI / (double(kCosines) * kAzimuths);
}

TEST(InterfaceTable, HoldsTheIntegralOverAllFacets) {
    for (const double alpha : {0.2, 0.6}) {
        const auto table = transmittanceTable(1.5, alpha, {.distribution = FacetDistribution::Ggx});
        for (const size_t piece : {5u, 8u, 12u}) {
            const double root = double(piece) / double(table.size());
            EXPECT_NEAR(double(table[piece].x), transmittedByFacets(1.5, alpha, root * root), 2e-4)
                << alpha << " " << piece;
        }
    }
}

/// The mean over few cosines that Mitsuba takes: 64 of them, of which both ends count in full, are
/// a trapezoidal sum of 63 pieces and half of what the normal view has too much, over 64.
TEST(InterfaceTable, InternalReflectanceIsAMeanOfFewViewsWhereThatIsAsked) {
    const Facets separable{.masking = FacetMasking::Separable};
    const double integral = internalReflectance(1.5, 0.01, separable);
    const double expected = (63 * integral + 0.04) / 64; // 2 mu F at mu = 1 is 0.08
    EXPECT_NEAR(internalReflectance(1.5, 0.01, separable, 64), expected, 1e-3);
    EXPECT_LT(internalReflectance(1.5, 0.01, separable, 64), 0.985 * integral + 1e-3);
}

/// What is low is hidden from both: independent heights let through less, on either side.
TEST(InterfaceTable, SeparableMaskingLetsThroughLess) {
    for (const FacetDistribution d : {FacetDistribution::Ggx, FacetDistribution::Beckmann}) {
        const Facets correlated{.distribution = d};
        const Facets separable{.distribution = d, .masking = FacetMasking::Separable};
        EXPECT_LT(internalReflectance(1.5, 0.5, separable),
                  internalReflectance(1.5, 0.5, correlated) - 1e-3);
    }
}

/// Light is scattered once alike in both directions: the share of diffuse light that gets out is
/// that of what gets in over the squared index, and it and what comes back are no more than 1.
TEST(InterfaceTable, IsReciprocal) {
    for (const FacetDistribution d : {FacetDistribution::Ggx, FacetDistribution::Beckmann})
        for (const double alpha : {1e-4, 0.1, 0.5, 1.0}) {
            const auto table = transmittanceTable(1.5, alpha, {.distribution = d});
            double in = 0;
            for (const glm::vec4& c : table)
                for (int i = 0; i < 200; ++i) {
                    const double x = (i + 0.5) / 200;
                    const double root = (double(&c - table.data()) + x) / double(table.size());
                    // 2 mu dmu, mu = root^2
                    in += (c.x + x * (c.y + x * (c.z + x * c.w))) * 4 * root * root * root /
                          (200.0 * double(table.size()));
                }
            const double back = internalReflectance(1.5, alpha, {.distribution = d});
            EXPECT_LT(in / 2.25 + back, 1 + 5e-4) << alpha;
            if (alpha == 1e-4) {
                EXPECT_NEAR(in / 2.25 + back, 1, 5e-4);
            }
        }
}

} // namespace
} // namespace stromboli
