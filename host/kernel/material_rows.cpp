#include "host/kernel/material_rows.hpp"

#include "host/kernel/interface_table.hpp"
#include "shaders/shared/texture_types.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stromboli {
namespace {

/// Rows that the kernel may read from the first row of a material on, whatever its kind.
constexpr size_t kMostRows = 7;
static_assert(gpu::MATERIAL_DETAIL_ROW >= kMostRows);

/// Anywhere on the surface: a texture may make less of a metal of it.
bool transmits(const Material& m) {
    const auto isMetallic = [](const TextureUse& t) {
        return t.slot == TextureSlot::MetallicRoughness;
    };
    const bool isAllMetal =
        m.principled.metallic >= 1 && std::ranges::none_of(m.textures, isMetallic);
    return m.principled.transmission > 0 && !isAllMetal;
}

bool refracts(const Material& m) {
    return transmits(m) && !m.principled.isThin;
}

/// glTF writes 0 for an index so large that everything is reflected.
constexpr float kLargestIndex = 1e6f;

float usedIndex(const Material& m) {
    const PrincipledParameters& p = m.principled;
    if (p.ior == 0) return kLargestIndex;
    if (!refracts(m) || std::abs(p.ior - 1) >= gpu::LEAST_INDEX_STEP) return p.ior;
    return p.ior < 1 ? 1 - gpu::LEAST_INDEX_STEP : 1 + gpu::LEAST_INDEX_STEP;
}

gpu::PrincipledParameters principledRows(const Material& m) {
    const PrincipledParameters& p = m.principled;
    // Beer and Lambert's law: attenuationColor = exp(-absorption attenuationDistance). A channel
    // that lets nothing through gets the largest coefficient whose product with a length is finite.
    constexpr float kLeastTransmitted = 1e-30f;
    const glm::vec3 left = glm::max(p.attenuationColor, glm::vec3(kLeastTransmitted));
    gpu::PrincipledParameters g{};
    g.baseColor = p.baseColor;
    g.metallic = p.metallic;
    g.specularColor = p.specularColor;
    g.roughness = p.roughness;
    g.specular = p.specular;
    g.ior = usedIndex(m);
    g.transmission = p.transmission;
    g.anisotropy = p.anisotropy;
    g.sheenColor = p.sheenColor;
    g.sheenRoughness = p.sheenRoughness;
    g.clearcoat = p.clearcoat;
    g.clearcoatRoughness = p.clearcoatRoughness;
    g.anisotropyRotation = p.anisotropyRotation;
    g.flags = p.isThin ? gpu::PRINCIPLED_IS_THIN : 0;
    g.absorption = -glm::log(left) / p.attenuationDistance;
    g.leastAlpha = gpu::LEAST_GGX_ALPHA;
    if (refracts(m))
        g.leastAlpha = std::max(g.leastAlpha, gpu::LEAST_REFRACTION_ALPHA * std::max(g.ior, 1.0f) /
                                                  std::abs(g.ior - 1));
    return g;
}

static_assert(kLeastAlpha == gpu::LEAST_GGX_ALPHA);
static_assert(kLeastRefractionAlpha == gpu::LEAST_REFRACTION_ALPHA);

/// FACETS_ bits.
uint32_t bitsOf(const Facets& facets) {
    const bool isBeckmann = facets.distribution == FacetDistribution::Beckmann;
    const bool isSeparable = facets.masking == FacetMasking::Separable;
    return (isBeckmann ? gpu::FACETS_BECKMANN : gpu::FACETS_GGX) |
           (isSeparable ? gpu::FACETS_SEPARABLE : gpu::FACETS_CORRELATED);
}

gpu::ConductorParameters conductorRows(const Material& m) {
    const glm::vec2 alpha = m.facetAlpha();
    return {m.reflectance, alpha.y, m.eta, alpha.x, m.k, bitsOf(m.facets)};
}

gpu::FacetDielectricParameters facetDielectricRows(const Material& m) {
    Material least = m;
    least.facets.alpha = glm::vec2(0);
    const glm::vec2 alpha = m.facetAlpha();
    return {m.transmittance,  alpha.y, m.reflectance, alpha.x, m.ior, least.facetAlpha().x,
            bitsOf(m.facets), 0};
}

/// Without the place of the table.
gpu::PlasticParameters plasticRows(const Material& m) {
    const float alpha = m.facetAlpha().x;
    const double inside = m.isSmooth()
                              ? internalReflectance(m.ior)
                              : internalReflectance(m.ior, alpha, m.facets, m.internalViews);
    const uint32_t flags = (m.isNonlinear ? gpu::PLASTIC_IS_NONLINEAR : 0) | bitsOf(m.facets);
    return {m.albedo, float(inside), m.reflectance, m.ior, alpha, flags, 0, 0};
}

gpu::BurleyParameters burleyRows(const BurleyParameters& p) {
    gpu::BurleyParameters g{};
    g.baseColor = p.baseColor;
    g.metallic = p.isThin ? 0 : p.metallic;
    g.flatness = p.flatness;
    g.diffuseTransmission = p.diffuseTransmission;
    g.leastAlpha = p.leastAlpha();
    g.roughness = p.roughness;
    g.specularTint = p.specularTint;
    g.ior = p.usedIor();
    g.transmission = p.transmission;
    g.anisotropy = p.anisotropy;
    g.sheen = glm::vec3(p.sheen);
    g.sheenTint = p.sheenTint;
    g.clearcoat = p.isThin ? 0 : p.clearcoat;
    g.clearcoatGloss = p.clearcoatGloss;
    g.flags = p.isThin ? gpu::BURLEY_IS_THIN : 0;
    return g;
}

void appendParameters(std::vector<Row>& rows, const Material& m) {
    switch (m.kind) {
    case MaterialKind::Diffuse:
        return appendRows(rows, gpu::DiffuseParameters{m.albedo, 0});
    case MaterialKind::Mirror:
        return appendRows(rows, gpu::MirrorParameters{m.reflectance, 0});
    case MaterialKind::Refraction:
        return appendRows(rows, gpu::RefractionParameters{m.transmittance, m.ior});
    case MaterialKind::Glass:
        return appendRows(rows, gpu::GlassParameters{m.reflectance, m.ior, m.transmittance, 0});
    case MaterialKind::Microfacet:
        return appendRows(rows, gpu::RoughConductorParameters{m.eta, m.alpha, m.k, 0});
    case MaterialKind::Principled:
        return appendRows(rows, principledRows(m));
    case MaterialKind::Conductor:
        return appendRows(rows, conductorRows(m));
    case MaterialKind::Dielectric:
        if (m.isSmooth())
            return appendRows(rows, gpu::GlassParameters{m.reflectance, m.ior, m.transmittance, 0});
        return appendRows(rows, facetDielectricRows(m));
    case MaterialKind::ThinDielectric:
        return appendRows(rows,
                          gpu::ThinDielectricParameters{m.transmittance, m.ior, m.reflectance, 0});
    case MaterialKind::Plastic:
        return appendRows(rows, plasticRows(m));
    case MaterialKind::Burley:
        return appendRows(rows, burleyRows(m.burley));
    }
}

/// Puts the tables of the interfaces of plastic behind all materials.
void appendTables(MaterialRows& packed, std::span<const Material> materials) {
    for (size_t i = 0; i < materials.size(); ++i) {
        const Material& m = materials[i];
        if (bsdfKind(m) != gpu::BSDF_FACET_PLASTIC) continue;
        constexpr size_t kRowOfTable = 3, kPlace = 2; // PlasticParameters::table
        static_assert(offsetof(gpu::PlasticParameters, table) ==
                      16 * (kRowOfTable - 1) + 4 * kPlace);
        packed.rows[packed.firstRow[i] + kRowOfTable][kPlace] = uint32_t(packed.rows.size());
        for (const glm::vec4& piece : transmittanceTable(m.ior, m.facetAlpha().x, m.facets))
            appendRows(packed.rows, piece);
    }
}

/// A blend is the last row of a material's details, and names another material by its number.
void nameOthers(MaterialRows& packed, std::span<const Material> materials,
                std::span<const std::vector<Row>> details) {
    for (size_t i = 0; i < details.size(); ++i) {
        const auto detail = std::bit_cast<gpu::MaterialDetail>(details[i].front());
        if ((detail.flags & gpu::DETAIL_IS_BLEND) == 0) continue;
        const size_t row = packed.firstRow[i] + gpu::MATERIAL_DETAIL_ROW + details[i].size() - 1;
        packed.rows[row][0] = packed.firstRow.at(materials[i].other);
    }
}

} // namespace

uint32_t facetBits(const Material& material) {
    if (const BurleyParameters& b = material.burley; material.kind == MaterialKind::Burley)
        return gpu::FACETS_GGX | gpu::FACETS_SEPARABLE |
               (b.transmits() ? gpu::BURLEY_HAS_TRANSMISSION : 0) |
               (b.isThin ? gpu::BURLEY_HAS_THIN : 0);
    const bool canHave = material.kind == MaterialKind::Conductor ||
                         material.kind == MaterialKind::Dielectric ||
                         material.kind == MaterialKind::Plastic;
    if (!canHave || material.isSmooth()) return 0;
    return bitsOf(material.facets);
}

uint32_t bsdfKind(const Material& material) {
    const bool isSmooth = material.isSmooth();
    switch (material.kind) {
    case MaterialKind::Diffuse:
        return gpu::BSDF_DIFFUSE;
    case MaterialKind::Mirror:
        return gpu::BSDF_MIRROR;
    case MaterialKind::Refraction:
        return gpu::BSDF_REFRACTION;
    case MaterialKind::Glass:
        return gpu::BSDF_GLASS;
    case MaterialKind::Microfacet:
        return gpu::BSDF_ROUGH_CONDUCTOR;
    case MaterialKind::Principled:
        return gpu::BSDF_PRINCIPLED;
    case MaterialKind::Conductor:
        return isSmooth ? gpu::BSDF_CONDUCTOR : gpu::BSDF_FACET_CONDUCTOR;
    case MaterialKind::Dielectric:
        return isSmooth ? gpu::BSDF_GLASS : gpu::BSDF_FACET_DIELECTRIC;
    case MaterialKind::ThinDielectric:
        return gpu::BSDF_THIN_DIELECTRIC;
    case MaterialKind::Plastic:
        return isSmooth ? gpu::BSDF_PLASTIC : gpu::BSDF_FACET_PLASTIC;
    case MaterialKind::Burley:
        return gpu::BSDF_BURLEY;
    }
    return gpu::BSDF_DIFFUSE;
}

uint32_t principledFeatures(const Material& material) {
    if (material.kind != MaterialKind::Principled) return 0;
    const PrincipledParameters& p = material.principled;
    uint32_t features = 0;
    if (p.clearcoat > 0) features |= gpu::PRINCIPLED_HAS_CLEARCOAT;
    if (p.sheenColor != glm::vec3(0)) features |= gpu::PRINCIPLED_HAS_SHEEN;
    if (p.anisotropy > 0) features |= gpu::PRINCIPLED_HAS_ANISOTROPY;
    if (transmits(material) && p.isThin) features |= gpu::PRINCIPLED_HAS_THIN_TRANSMISSION;
    if (refracts(material)) features |= gpu::PRINCIPLED_HAS_REFRACTION;
    if (refracts(material) && principledRows(material).absorption != glm::vec3(0))
        features |= gpu::PRINCIPLED_HAS_ABSORPTION;
    return features;
}

uint32_t reliefBits(const Material& m) {
    constexpr uint32_t kRules[] = {0, gpu::MATERIAL_RELIEF_FLIPS, gpu::MATERIAL_RELIEF_BLACKENS};
    return kRules[size_t(m.reliefRule)] | (m.reliefShadows ? gpu::MATERIAL_RELIEF_SHADOWS : 0);
}

MaterialRows packMaterials(std::span<const Material> materials,
                           std::span<const std::vector<Row>> details) {
    MaterialRows packed;
    for (const Material& m : materials) {
        packed.firstRow.push_back(uint32_t(packed.rows.size()));
        appendRows(packed.rows,
                   gpu::MaterialHeader{
                       m.emission,
                       bsdfKind(m) | (m.emitsBothSides ? gpu::MATERIAL_EMITS_BOTH_SIDES : 0) |
                           (m.isBlackBehind ? gpu::MATERIAL_IS_BLACK_BEHIND : 0) | reliefBits(m)});
        appendParameters(packed.rows, m);
        if (details.empty()) continue;
        const std::vector<Row>& own = details[packed.firstRow.size() - 1];
        packed.rows.resize(packed.firstRow.back() + gpu::MATERIAL_DETAIL_ROW);
        for (const Row& row : own)
            packed.rows.push_back(row);
    }
    packed.rows.resize(packed.rows.size() + kMostRows - 1);
    appendTables(packed, materials);
    nameOthers(packed, materials, details);
    return packed;
}

} // namespace stromboli
