// Sets of parameters of conductors, rough and thin dielectrics and plastic on which all tests of
// the BSDF contract are run.
#include "tests/shaders/bsdf_cases.hpp"

#include <algorithm>

namespace stromboli::test {
namespace {

/// Fresnel's equations for a dielectric, in tens of roundings of terms of size 1; of what is
/// transmitted at a grazing view, which is as small as its cosine, tolerances have them already.
constexpr double kFresnel = 1e-5;
/// Tolerance of Fresnel's equations for conductors (bsdf_terms_test.cpp has 120 ulp of 1).
constexpr double kConductorFresnel = 3e-5;
/// Both sides' tables of an interface's transmittance, right to 5e-4, by which densities are
/// divided between the lobes: of what the interface reflects, 0.04 at least, that is 1 %.
constexpr double kTables = 1e-2;

struct NamedFacets {
    const char* name;
    FacetDistribution distribution;
    FacetMasking masking;
};
constexpr NamedFacets kFacets[] = {
    {"Ggx", FacetDistribution::Ggx, FacetMasking::Correlated},
    {"Beckmann", FacetDistribution::Beckmann, FacetMasking::Correlated},
    {"SeparableGgx", FacetDistribution::Ggx, FacetMasking::Separable},
    {"SeparableBeckmann", FacetDistribution::Beckmann, FacetMasking::Separable}};

BsdfCase caseOf(std::string name, const Material& m, double leastWhite) {
    BsdfCase c{std::move(name), m, m, leastWhite};
    c.white.albedo = c.white.reflectance = c.white.transmittance = glm::vec3(1);
    c.white.eta = glm::vec3(1);
    c.white.k = glm::vec3(1e6f); // a perfect conductor reflects all
    if (m.isSmooth()) return c;
    const glm::vec2 alpha = m.facetAlpha();
    c.lobe = m.kind == MaterialKind::Plastic ? alpha.x : std::min(alpha.x, alpha.y);
    c.smooth = c.lobe >= 0.2;
    return c;
}

std::string digits(float alpha) {
    return std::to_string(int(alpha * 1e4f + 0.5f));
}

void addConductors(std::vector<BsdfCase>& cases) {
    Material m;
    m.kind = MaterialKind::Conductor;
    m.reflectance = {0.9f, 0.8f, 1.0f};
    m.eta = {0.143f, 0.375f, 1.442f};
    m.k = {3.983f, 2.386f, 1.603f};
    cases.push_back(caseOf("conductor", m, 1 - 1e-5));
    for (const auto& [name, distribution, masking] : kFacets) {
        m.facets.distribution = distribution;
        m.facets.masking = masking;
        for (const glm::vec2 alpha :
             {glm::vec2(1e-4f), glm::vec2(0.01f), glm::vec2(0.1f), glm::vec2(0.5f), glm::vec2(1),
              glm::vec2(0.4f, 0.05f), glm::vec2(0.3f, 0.9f)}) {
            m.facets.alpha = alpha;
            const float rough = std::max(alpha.x, alpha.y);
            // What would be reflected twice is lost.
            const double least = rough > 0.6f ? 0.3 : rough > 0.3f ? 0.65 : 0.95;
            cases.push_back(
                caseOf(std::string("conductor") + name + digits(alpha.x) + "_" + digits(alpha.y), m,
                       least));
            cases.back().error = kConductorFresnel;
        }
    }
}

void addDielectrics(std::vector<BsdfCase>& cases) {
    Material m;
    m.reflectance = {0.8f, 0.4f, 0.2f};
    m.transmittance = {0.9f, 0.5f, 0.1f};
    for (const float ior : {1.5f, 0.7f}) {
        m.ior = ior;
        const std::string suffix = ior < 1 ? "Inverted" : "";
        // Into the denser side radiance is compressed by the squared index.
        const double stretched = std::max(1 / (ior * ior), 1.0f) - 1;
        m.kind = MaterialKind::ThinDielectric;
        cases.push_back(caseOf("thinDielectric" + suffix, m, 1 - 1e-6));
        m.kind = MaterialKind::Dielectric;
        m.facets = {};
        cases.push_back(caseOf("dielectric" + suffix, m, 0.44));
        cases.back().gain = stretched;
        for (const auto& [name, distribution, masking] : kFacets) {
            m.facets.distribution = distribution;
            m.facets.masking = masking;
            for (const glm::vec2 alpha : {glm::vec2(1.2e-4f), glm::vec2(0.03f), glm::vec2(0.3f),
                                          glm::vec2(1), glm::vec2(0.6f, 0.25f)}) {
                m.facets.alpha = alpha;
                cases.push_back(
                    caseOf("dielectric" + suffix + name + digits(alpha.x) + "_" + digits(alpha.y),
                           m, 0.3));
                // The areas of both directions are in separable masking as they are.
                cases.back().error = masking == FacetMasking::Separable ? 2 * kFresnel : kFresnel;
                cases.back().gain = stretched;
            }
        }
    }
}

void addPlastic(std::vector<BsdfCase>& cases) {
    Material m;
    m.kind = MaterialKind::Plastic;
    m.albedo = {0.8f, 0.3f, 0.05f};
    m.reflectance = {0.9f, 0.7f, 0.5f};
    for (const float ior : {1.5f, 0.95f})
        for (const bool isNonlinear : {false, true}) {
            m.ior = ior;
            m.isNonlinear = isNonlinear;
            const std::string suffix =
                std::string(ior < 1 ? "Inverted" : "") + (isNonlinear ? "Nonlinear" : "");
            m.facets = {};
            cases.push_back(caseOf("plastic" + suffix, m, ior < 1 ? 0.98 : 1 - 1e-3));
            // At the critical angle a root makes 3e-4 of a rounding, of what may be a tenth.
            cases.back().error = ior < 1 ? 3e-3 : kFresnel;
            cases.back().gain = 1e-4; // of the noise of a view that reflects nearly all
            // Where the denser side is above, diffuse samples that meet total reflection are lost.
            cases.back().smooth = ior > 1;
            for (const auto& [name, distribution, masking] : kFacets) {
                m.facets.distribution = distribution;
                m.facets.masking = masking;
                for (const float alpha : {1e-4f, 0.1f, 0.3f, 1.0f}) {
                    if (isNonlinear && alpha != 0.3f) continue;
                    // What facets let through beyond a critical angle is less than the tables know.
                    if (ior < 1) continue;
                    m.internalViews = masking == FacetMasking::Separable ? 64 : 0;
                    m.facets.alpha = glm::vec2(alpha);
                    cases.push_back(caseOf("plastic" + suffix + name + digits(alpha), m,
                                           alpha > 0.5f ? 0.25 : 0.65));
                    cases.back().error = kTables;
                    cases.back().gain = 2e-3;
                }
            }
        }
}

void addBurley(std::vector<BsdfCase>& cases) {
    const auto add = [&](const std::string& name, auto&& change) {
        Material m;
        m.kind = MaterialKind::Burley;
        m.burley.baseColor = {0.9f, 0.6f, 0.3f};
        change(m.burley);
        BsdfCase c{name, m, m, 0};
        c.white.burley.baseColor = glm::vec3(1);
        const BurleyParameters& b = m.burley;
        const float alpha = b.roughness * b.roughness * std::sqrt(1 - 0.9f * b.anisotropy);
        const float coat = b.clearcoat > 0 ? 0.1f + (0.001f - 0.1f) * b.clearcoatGloss : 1.0f;
        c.lobe = std::min(std::max(alpha, b.leastAlpha()), coat);
        c.smooth = c.lobe >= 0.2;
        // The logarithm of the coat's distribution and powers of five, some tens of roundings.
        c.error = 5e-5;
        c.gain = 0.65; // lobes are added: retro-reflection and the interface at grazing views
        c.gain += 0.4 * b.sheen + 0.25 * b.clearcoat;
        cases.push_back(c);
    };
    for (const float roughness : {0.03f, 0.15f, 0.5f, 1.0f}) {
        const std::string suffix = digits(roughness);
        add("burley" + suffix, [&](BurleyParameters& b) { b.roughness = roughness; });
        add("burleyMetal" + suffix, [&](BurleyParameters& b) {
            b.roughness = roughness, b.metallic = 0.8f, b.anisotropy = 0.7f, b.specularTint = 0.6f;
        });
        add("burleyGlass" + suffix, [&](BurleyParameters& b) {
            b.roughness = roughness, b.transmission = 0.9f, b.anisotropy = 0.4f;
        });
        add("burleyThin" + suffix, [&](BurleyParameters& b) {
            b.roughness = roughness, b.transmission = 0.6f, b.isThin = true, b.ior = 1.33f;
            b.diffuseTransmission = 0.3f, b.sheen = 0.5f, b.specularTint = 0.5f;
        });
    }
    add("burleyCloth", [](BurleyParameters& b) {
        b.roughness = 0.9f, b.sheen = 0.9f, b.sheenTint = 0.6f, b.flatness = 0.7f;
    });
    add("burleyCoated", [](BurleyParameters& b) {
        b.roughness = 0.6f, b.clearcoat = 0.9f, b.clearcoatGloss = 0.2f;
    });
    add("burleyThinDiffuse", [](BurleyParameters& b) {
        b.isThin = true, b.diffuseTransmission = 0.7f, b.flatness = 0.5f;
    });
    add("burleyMixture", [](BurleyParameters& b) {
        b.roughness = 0.4f, b.metallic = 0.3f, b.transmission = 0.5f, b.clearcoat = 0.5f;
        b.sheen = 0.4f, b.specularTint = 0.3f, b.ior = 1.8f, b.anisotropy = 0.5f;
    });
}

} // namespace

std::vector<BsdfCase> facetCases() {
    std::vector<BsdfCase> cases;
    addConductors(cases);
    addDielectrics(cases);
    addPlastic(cases);
    addBurley(cases);
    return cases;
}

} // namespace stromboli::test
