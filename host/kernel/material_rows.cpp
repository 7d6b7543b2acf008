#include "host/kernel/material_rows.hpp"

#include "host/kernel/facet_terms.hpp"
#include "scene/model/mixture.hpp"
#include "shaders/shared/medium_types.h"
#include "shaders/shared/parameters.h"
#include "shaders/shared/texture_types.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

namespace stromboli {

// --- Materials -----------------------------------------------------------------------------------

namespace {

/// Rows that the kernel may read from the first row of a material on, whatever its kind.
constexpr size_t kMostRows = gpu::MOST_PARAMETER_ROWS + 1;
static_assert(gpu::MATERIAL_DETAIL_ROW >= kMostRows);

/// Everywhere on the surface: a texture may make less of a metal of it.
bool isAllMetal(const Material& m, float metallic) {
    const auto isMetallic = [](const TextureUse& t) {
        return t.slot == TextureSlot::MetallicRoughness;
    };
    return metallic >= 1 && std::ranges::none_of(m.textures, isMetallic);
}

bool transmits(const Material& m) {
    return m.principled.transmission > 0 && !isAllMetal(m, m.principled.metallic);
}

bool refracts(const Material& m) {
    return transmits(m) && !m.principled.isThin;
}

bool passesDiffusely(const Material& m) {
    return m.principled.diffuseTransmission > 0 && !isAllMetal(m, m.principled.metallic);
}

/// glTF writes 0 for an index so large that everything is reflected.
constexpr float kLargestIndex = 1e6f;

float usedIndex(const Material& m) {
    const PrincipledParameters& p = m.principled;
    if (p.ior == 0) return kLargestIndex;
    if (!refracts(m) || std::abs(p.ior - 1) >= gpu::LEAST_INDEX_STEP) return p.ior;
    return p.ior < 1 ? 1 - gpu::LEAST_INDEX_STEP : 1 + gpu::LEAST_INDEX_STEP;
}

float indexSpreadOf(const Material& m) {
    if (m.principled.isThin) return -1;
    return isDispersive(m) ? m.principled.indexSpread() : 0;
}

float leastAlphaOf(const Material& m) {
    if (!refracts(m)) return gpu::LEAST_GGX_ALPHA;
    // Red light is refracted least.
    const float red = usedIndex(m) - std::max(indexSpreadOf(m), 0.0f);
    const float ior = isDispersive(m) ? std::max(red, 1 + gpu::LEAST_INDEX_STEP) : red;
    return std::max(gpu::LEAST_GGX_ALPHA,
                    gpu::LEAST_REFRACTION_ALPHA * std::max(ior, 1.0f) / std::abs(ior - 1));
}

static_assert(kLeastAlpha == gpu::LEAST_GGX_ALPHA);
static_assert(kLeastRefractionAlpha == gpu::LEAST_REFRACTION_ALPHA);

/// The stated parameters that a kind of material stands for.
struct Stated {
    glm::vec3 color, edge, index{0.0f};
    float alphaX, alphaY;

    explicit Stated(const Material& m)
        : color(m.reflectance), edge(m.reflectance), alphaX(m.facetAlpha().x),
          alphaY(m.facetAlpha().y) {
        index[gpu::INDEX_RATIO] = m.ior;
        switch (m.kind) {
        case MaterialKind::Diffuse:
            color = m.albedo;
            break;
        case MaterialKind::Mirror:
            break;
        case MaterialKind::Conductor:
            edge = m.eta;
            index = m.k;
            break;
        case MaterialKind::Plastic:
            color = m.albedo;
            alphaY = alphaX;
            index[gpu::INDEX_BACK] =
                float(m.isSmooth() ? internalReflectance(m.ior)
                                   : internalReflectance(m.ior, alphaX, m.facets, m.internalViews));
            break;
        default: {
            color = m.transmittance;
            Material least = m;
            least.facets.alpha = glm::vec2(0);
            index[gpu::INDEX_LEAST_ALPHA] = least.facetAlpha().x;
            if (m.isSmooth()) alphaY = m.ior;
        }
        }
    }
};

/// The parameters of its recipe (shaders/shared/parameters.h).
void appendParameters(std::vector<Row>& rows, const Material& m) {
#define PACK(type, name, row, place, value) p.name = value;
    if (m.kind == MaterialKind::Principled) {
        gpu::PrincipledParameters p;
        PRINCIPLED_PARAMETERS(PACK)
        appendRows(rows, p);
    } else if (m.kind == MaterialKind::Burley) {
        gpu::BurleyParameters p;
        BURLEY_PARAMETERS(PACK)
        appendRows(rows, p);
    } else {
        const Stated stated(m);
        gpu::StatedParameters p;
        STATED_PARAMETERS(PACK)
        appendRows(rows, p);
    }
#undef PACK
}

/// Where a table says that a parameter is.
constexpr size_t bytesBefore(size_t row, const char* place) {
    const char first = place[0];
    return 16 * (row - 1) + 4 * size_t(first == 'w' ? 3 : first - 'x');
}
#define IS_THERE(structure, name, row, place)                                                      \
    static_assert(offsetof(gpu::structure, name) == bytesBefore(row, #place), #name);
#define STATED_IS_THERE(type, name, row, place, value) IS_THERE(StatedParameters, name, row, place)
#define PRINCIPLED_IS_THERE(type, name, row, place, value)                                         \
    IS_THERE(PrincipledParameters, name, row, place)
#define BURLEY_IS_THERE(type, name, row, place, value) IS_THERE(BurleyParameters, name, row, place)
STATED_PARAMETERS(STATED_IS_THERE)
PRINCIPLED_PARAMETERS(PRINCIPLED_IS_THERE)
BURLEY_PARAMETERS(BURLEY_IS_THERE)
#undef IS_THERE
#undef STATED_IS_THERE
#undef PRINCIPLED_IS_THERE
#undef BURLEY_IS_THERE

uint32_t facetBits(const Facets& facets) {
    const bool isBeckmann = facets.distribution == FacetDistribution::Beckmann;
    const bool isSeparable = facets.masking == FacetMasking::Separable;
    return (isBeckmann ? gpu::FACETS_ARE_BECKMANN : 0) |
           (isSeparable ? gpu::FACETS_ARE_SEPARABLE : 0);
}

bool absorbs(const Material& m) {
    const bool hasVolume = !m.principled.isThin && (transmits(m) || passesDiffusely(m));
    return hasVolume && m.principled.absorption() != glm::vec3(0);
}

/// Through Burley's model; a texture may make less of a metal of it.
bool passesThrough(const Material& m) {
    const stromboli::BurleyParameters& p = m.burley;
    return p.isThin ? p.transmits() : p.transmission > 0 && !isAllMetal(m, p.metallic);
}

/// Puts the tables of the interfaces of plastic behind all materials, one for all that are alike.
void appendTables(MaterialRows& packed, std::span<const Material> materials) {
    std::map<std::tuple<float, float, FacetDistribution, FacetMasking>, uint32_t> rowOf;
    for (size_t i = 0; i < materials.size(); ++i) {
        const Material& m = materials[i];
        if (m.kind != MaterialKind::Plastic || m.isSmooth()) continue;
        const auto [known, isNew] =
            rowOf.try_emplace({m.ior, m.facetAlpha().x, m.facets.distribution, m.facets.masking},
                              uint32_t(packed.rows.size()));
        static_assert(offsetof(gpu::StatedParameters, table) == 16 * gpu::STATED_TABLE_ROW - 4);
        packed.rows[packed.firstRow[i] + gpu::STATED_TABLE_ROW][3] = known->second;
        if (!isNew) continue;
        for (const glm::vec4& piece : transmittanceTable(m.ior, m.facetAlpha().x, m.facets))
            appendRows(packed.rows, piece);
    }
}

static_assert(gpu::MOST_BLENDS + 1 == kMostOfAMixture);
static_assert(gpu::MOST_BLENDS <= gpu::BLEND_OTHERS_MASK);

/// BLEND_ bits: how many materials are evaluated with any one of a mixture, and the lobes of all.
uint32_t blendBits(std::span<const Material> materials, std::span<const uint32_t> mixture) {
    if (!areEvaluatedTogether(materials, mixture)) return 0;
    uint32_t lobes = 0;
    for (const uint32_t i : mixture)
        lobes |= closureBits(materials[i]) & gpu::LOBE_MASK;
    return uint32_t(mixture.size() - 1) << gpu::BLEND_OTHERS_SHIFT | lobes
                                                                         << gpu::BLEND_LOBES_SHIFT;
}

/// A blend is the last row of a material's details, and names another material by its number.
void nameOthers(MaterialRows& packed, std::span<const Material> materials,
                std::span<const std::vector<Row>> details) {
    for (size_t i = 0; i < details.size(); ++i) {
        const auto detail = std::bit_cast<gpu::MaterialDetail>(details[i].front());
        if ((detail.flags & gpu::DETAIL_IS_BLEND) == 0) continue;
        const size_t row = packed.firstRow[i] + gpu::MATERIAL_DETAIL_ROW + details[i].size() - 1;
        auto blend = std::bit_cast<gpu::BlendRow>(packed.rows[row]);
        const std::vector<uint32_t> mixture = materialsOfMixture(materials, uint32_t(i));
        const uint32_t bits = blendBits(materials, mixture);
        blend.other = packed.firstRow.at(materials[i].other);
        blend.place = uint32_t(materials[i].otherPlace) | bits;
        packed.rows[row] = std::bit_cast<Row>(blend);
        packed.mostBlends = std::max(packed.mostBlends, uint32_t(mixture.size() - 1));
        packed.mostOthers =
            std::max(packed.mostOthers, bits >> gpu::BLEND_OTHERS_SHIFT & gpu::BLEND_OTHERS_MASK);
    }
}

} // namespace

bool isDispersive(const Material& m) {
    return m.kind == MaterialKind::Principled && refracts(m) && m.principled.indexSpread() > 0;
}

bool isIridescent(const Material& m) {
    return m.kind == MaterialKind::Principled && m.principled.iridescence > 0;
}

uint32_t closureBits(const Material& m) {
    using namespace gpu;
    const bool isSmooth = m.isSmooth();
    const uint32_t plane = isSmooth ? INTERFACE_IS_SMOOTH : facetBits(m.facets);
    const uint32_t reflects = isSmooth ? LOBE_DELTA_REFLECTION : LOBE_GLOSSY_REFLECTION;
    const uint32_t passes = isSmooth ? LOBE_DELTA_TRANSMISSION : LOBE_GLOSSY_TRANSMISSION;
    uint32_t bits = m.baseColor() != nullptr ? HAS_BASE_COLOR : 0;
#define ADD_BITS(kind_, when, bits_)                                                               \
    if (m.kind == MaterialKind::kind_ && (when)) bits |= (bits_);
    CLOSURES_OF_KINDS(ADD_BITS)
#undef ADD_BITS
    return bits;
}

void SceneClosures::add(uint32_t bits) {
    uint32_t ofNoConcern = 0;
    if (!(bits & gpu::CLOSURE_INTERFACE)) ofNoConcern |= gpu::INTERFACE_BITS;
    if (!(bits & gpu::CLOSURE_INTERFACE) || (bits & gpu::INTERFACE_IS_SMOOTH))
        ofNoConcern |= gpu::FACETS_BITS;
    some |= bits;
    all &= bits | ofNoConcern;
}

uint32_t reliefBits(const Material& m) {
    constexpr uint32_t kRules[] = {0, gpu::MATERIAL_RELIEF_FLIPS, gpu::MATERIAL_RELIEF_BLACKENS};
    return kRules[size_t(m.reliefRule)] | (m.reliefShadows ? gpu::MATERIAL_RELIEF_SHADOWS : 0);
}

MaterialRows packMaterials(std::span<const Material> materials,
                           std::span<const std::vector<Row>> details,
                           std::span<const Medium> media) {
    MaterialRows packed;
    for (const Material& m : materials) {
        if (!media.empty()) packed.rows.resize(packed.rows.size() + gpu::MEDIUM_BORDER_ROWS);
        packed.firstRow.push_back(uint32_t(packed.rows.size()));
        appendRows(packed.rows,
                   gpu::MaterialHeader{
                       m.emission,
                       closureBits(m) | (m.emitsBothSides ? gpu::MATERIAL_EMITS_BOTH_SIDES : 0) |
                           (m.isBlackBehind ? gpu::MATERIAL_IS_BLACK_BEHIND : 0) | reliefBits(m)});
        appendParameters(packed.rows, m);
        if (details.empty()) continue;
        const std::vector<Row>& own = details[packed.firstRow.size() - 1];
        packed.rows.resize(packed.firstRow.back() + gpu::MATERIAL_DETAIL_ROW);
        for (const Row& row : own)
            packed.rows.push_back(row);
    }
    packed.media = appendMedia(packed.rows, media, !details.empty());
    if (!media.empty()) nameBorders(packed.rows, materials, packed.firstRow, packed.media.firstRow);
    if (std::ranges::any_of(materials, &Material::outsideIsOpen))
        packed.media.kinds |= gpu::MEDIA_OVERLAP;
    // The kernel reads as many rows from the first on, for materials without a table.
    packed.rows.resize(
        std::max(packed.rows.size() + kMostRows - 1, size_t(gpu::TRANSMITTANCE_PIECES)));
    appendTables(packed, materials);
    nameOthers(packed, materials, details);
    return packed;
}

} // namespace stromboli
