#include "host/kernel/detail_rows.hpp"

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/texel_packer.hpp"
#include "scene/model/surface_lookup.hpp"
#include "shaders/shared/texture_types.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stromboli {

namespace {

// --- Attributes and textures ---------------------------------------------------------------------

Row row(float a, float b, float c, float d) {
    return {std::bit_cast<uint32_t>(a), std::bit_cast<uint32_t>(b), std::bit_cast<uint32_t>(c),
            std::bit_cast<uint32_t>(d)};
}

/// The lowest bits of a number in two's complement.
uint32_t bits(int32_t number, uint32_t count) {
    return uint32_t(number) & ((1u << count) - 1);
}

/// The attributes of all primitives, in the order of the tree's leaves.
class AttributePacker {
  public:
    AttributePacker(const Scene& scene, const WideLayout& bvh, uint32_t attributes, RowPages& rows)
        : scene_(scene), bvh_(bvh), attributes_(attributes), rows_(rows) {}

    void pack() {
        if (attributes_ == 0) return;
        rows_.reserve(bvh_.primitiveOrder.size() * attributeRows(attributes_));
        for (const uint32_t id : bvh_.primitiveOrder)
            pack(id);
    }

  private:
    bool has(uint32_t attribute) const { return (attributes_ & attribute) != 0; }

    void pack(uint32_t id) {
        VertexAttributes corners[3];
        const bool isTriangle = id < scene_.triangles.size();
        if (isTriangle && scene_.attributeCorners[id][0] != kNoAttributes)
            for (uint32_t c = 0; c < 3; ++c)
                corners[c] = scene_.attributes[scene_.attributeCorners[id][cornerOf(id, c)]];
        for (const uint32_t set : {0u, 1u})
            if (has(set == 0 ? gpu::ATTRIBUTE_UV0 : gpu::ATTRIBUTE_UV1)) packUv(corners, set);
        if (has(gpu::ATTRIBUTE_COLOR))
            for (const VertexAttributes& a : corners)
                rows_.push_back(row(a.color.x, a.color.y, a.color.z, a.color.w));
        if (has(gpu::ATTRIBUTE_TANGENT)) rows_.push_back(isTriangle ? tangents(id) : Row{});
    }

    void packUv(const VertexAttributes (&corners)[3], uint32_t set) {
        const glm::vec2 a = corners[0].uv[set], b = corners[1].uv[set], c = corners[2].uv[set];
        rows_.push_back(row(a.x, a.y, b.x, b.y));
        rows_.push_back(row(c.x, c.y, 0, 0));
    }

    Row tangents(uint32_t id) const {
        Row r{};
        const Material& material = scene_.materials[scene_.triangles[id].material];
        const uint32_t set = uvSetOfTangents(material);
        for (uint32_t c = 0; c < 3; ++c) {
            const glm::vec4 t = tangentAtCorner(scene_, id, cornerOf(id, c), set);
            const float length = glm::length(glm::vec3(t));
            if (t.w == 0 || !(length > 0) || !std::isfinite(length)) return Row{};
            const glm::ivec3 v = glm::round(glm::vec3(t) * (8191 / length));
            r[c] = bits(v.x, 14) | bits(v.y, 14) << 14 | bits(v.z, 4) << 28;
            r[3] |= bits(v.z >> 4, 10) << 10 * c;
            if (c == 0) r[3] |= (t.w > 0 ? 1u : 3u) << 30;
        }
        return r;
    }

    /// The corner of the file that the leaf has as its c-th.
    uint32_t cornerOf(uint32_t id, uint32_t c) const { return (c + bvh_.firstCorner[id]) % 3; }

    const Scene& scene_;
    const WideLayout& bvh_;
    uint32_t attributes_;
    RowPages& rows_;
};

/// All but where its texels are, and what they hold.
gpu::TextureUse packLookup(const Scene& scene, const TextureUse& use) {
    const Texture& texture = scene.textures[use.texture];
    const TextureImage& image = scene.images[texture.image];
    gpu::TextureUse g{};
    g.uRow = use.uRow;
    g.vRow = use.vRow;
    g.scale = use.scale;
    g.width = image.width;
    g.height = image.height;
    g.flags = uint32_t(use.slot) | (use.uvSet != 0 ? gpu::TEXTURE_SECOND_UV : 0) |
              uint32_t(texture.wrapU) << gpu::TEXELS_WRAP_U_SHIFT |
              uint32_t(texture.wrapV) << gpu::TEXELS_WRAP_V_SHIFT |
              (texture.nearest ? gpu::TEXELS_NEAREST : 0);
    return g;
}

/// opacity: that the texels hold as their alpha.
gpu::TextureUse packUse(const Scene& scene, const TextureUse& use,
                        const std::optional<TextureUse>& opacity, TexelPacker& texels) {
    const Texture& texture = scene.textures[use.texture];
    gpu::TextureUse g = packLookup(scene, use);
    if (opacity) {
        g.firstRow = texels.firstRowOf(use, *opacity);
        return g;
    }
    g.firstRow = texels.firstRowOf(texture);
    const bool isSrgb = texture.srgb && scene.images[texture.image].format == TexelFormat::Rgba8;
    g.flags |= (texels.isPlain(texture) ? gpu::TEXELS_PLAIN : 0) |
               (texels.isHalf(texture) ? gpu::TEXELS_HALF : 0) | (isSrgb ? gpu::TEXELS_SRGB : 0);
    return g;
}

gpu::TextureUse packBundle(const Scene& scene, const DetailPlan::Bundle& bundle,
                           TexelPacker& texels) {
    const auto first =
        std::ranges::find_if(bundle, [](const auto& map) { return map.has_value(); });
    gpu::TextureUse g = packLookup(scene, **first);
    if (const auto& normal = bundle[gpu::TEXTURE_NORMAL]) {
        g.scale = normal->scale;
        g.flags |= gpu::TEXELS_MAP_NORMALS;
    }
    g.firstRow = texels.firstRowOf(bundle);
    g.flags |= gpu::TEXELS_BUNDLE;
    return g;
}

/// The texture use of a material that has no maps in a bundle, in a scene where others have.
gpu::TextureUse emptyBundle(TexelPacker& texels) {
    gpu::TextureUse g{};
    g.firstRow = texels.firstRowOf(DetailPlan::Bundle{});
    g.width = g.height = 1;
    g.flags = gpu::TEXELS_BUNDLE;
    return g;
}

std::vector<Row> materialDetail(const Scene& scene, const Material& m,
                                const DetailPlan::MaterialPlan& plan, bool sceneHasBundles,
                                TexelPacker& texels) {
    gpu::MaterialDetail detail{};
    detail.opacity = m.opacity;
    detail.alphaCutoff = m.alphaCutoff;
    detail.looseTextures = uint32_t(plan.textures.size());
    if (plan.isTransparent)
        detail.flags = m.alphaMode == AlphaMode::Mask ? gpu::DETAIL_MASK : gpu::DETAIL_BLEND;
    if (plan.isHidden) detail.flags |= gpu::DETAIL_IS_HIDDEN;
    std::vector<Row> uses;
    if (m.mirrorsReliefBehind) detail.flags |= gpu::DETAIL_MIRRORS_RELIEF;
    if (plan.coatHasNormal) detail.flags |= gpu::DETAIL_COAT_HAS_NORMAL;
    uint32_t number = 0, shareTexture = 0;
    if (plan.bundle)
        appendRows(uses, packBundle(scene, *plan.bundle, texels));
    else if (sceneHasBundles)
        appendRows(uses, emptyBundle(texels));
    if (sceneHasBundles) ++number;
    for (const TextureUse& use : plan.textures) {
        if (use.slot == TextureSlot::BlendShare) shareTexture = number + 1;
        if (use.slot == TextureSlot::ClearcoatNormal)
            detail.looseTextures |= (number + 1) << gpu::DETAIL_COAT_NORMAL_SHIFT;
        ++number;
        const bool isColor = use.slot == TextureSlot::BaseColor;
        appendRows(uses, packUse(scene, use, isColor ? plan.opacity : std::nullopt, texels));
    }
    if (plan.isBlend) {
        detail.flags |= gpu::DETAIL_IS_BLEND;
        // packMaterials() knows the other material's row.
        appendRows(uses,
                   gpu::BlendRow{m.other, m.otherShare, shareTexture, uint32_t(m.otherPlace)});
    }
    std::vector<Row> rows;
    appendRows(rows, detail);
    rows.insert(rows.end(), uses.begin(), uses.end());
    return rows;
}

} // namespace

uint32_t attributeRows(uint32_t attributes) {
    return (attributes & gpu::ATTRIBUTE_UV0 ? gpu::UV_ROWS : 0) +
           (attributes & gpu::ATTRIBUTE_UV1 ? gpu::UV_ROWS : 0) +
           (attributes & gpu::ATTRIBUTE_COLOR ? gpu::COLOR_ROWS : 0) +
           (attributes & gpu::ATTRIBUTE_TANGENT ? gpu::TANGENT_ROWS : 0);
}

DetailRows packDetails(const Scene& scene, const WideLayout& bvh, const DetailPlan& plan) {
    DetailRows details;
    AttributePacker(scene, bvh, plan.attributes, details.rows).pack();
    details.firstTexel = details.rows.size();
    if (!plan.hasMaterialDetails()) return details;
    TexelPacker texels(scene, plan, details.rows);
    for (size_t i = 0; i < scene.materials.size(); ++i)
        details.ofMaterials.push_back(materialDetail(scene, scene.materials[i], plan.materials[i],
                                                     plan.hasBundles(), texels));
    for (const Light& light : scene.lights) {
        std::vector<Row>& rows = details.ofLights.emplace_back();
        if (light.picture) appendRows(rows, packUse(scene, *light.picture, std::nullopt, texels));
    }
    texels.pack();
    return details;
}

DetailRows repackAttributes(const Scene& scene, const WideLayout& bvh, uint32_t attributes,
                            const DetailRows& before) {
    DetailRows details{{}, before.ofLights, before.ofMaterials, before.firstTexel};
    details.rows.reserve(before.rows.size());
    AttributePacker(scene, bvh, attributes, details.rows).pack();
    // As many primitives have as many rows, so that texels stay where rows of materials name them.
    details.rows.insert(details.rows.end(), before.rows.begin() + std::ptrdiff_t(before.firstTexel),
                        before.rows.end());
    return details;
}

} // namespace stromboli
