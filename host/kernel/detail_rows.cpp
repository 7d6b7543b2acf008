#include "host/kernel/detail_rows.hpp"

#include "host/kernel/gpu_scene.hpp"
#include "scene/model/srgb.hpp"
#include "scene/model/surface_lookup.hpp"
#include "shaders/shared/texture_types.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace stromboli {

// --- Texels --------------------------------------------------------------------------------------

namespace {

/// Numbers of gpu::TextureUse for each byte.
struct ByteTable {
    std::array<uint32_t, 256> fractions, linearFractions, roots;
    ByteTable() {
        for (uint32_t byte = 0; byte < 256; ++byte) {
            const double linear = srgbToLinear(byte / 255.0);
            fractions[byte] = 257 * byte;
            linearFractions[byte] = uint32_t(std::lround(65535 * linear));
            roots[byte] = uint32_t(std::lround(4095 * std::sqrt(linear)));
        }
    }
};

const ByteTable& byteTable() {
    static const ByteTable table;
    return table;
}

uint32_t byteOf(uint32_t word, uint32_t channel) {
    return word >> 8 * channel & 0xFF;
}

/// The texel of a picture of n texels that stands for the i-th, i from -1 to n.
uint32_t edged(int64_t i, uint32_t n, Wrap wrap) {
    if (i >= 0 && i < int64_t(n)) return uint32_t(i);
    const bool isFirst = (i < 0) != (wrap == Wrap::Repeat);
    return isFirst ? 0 : n - 1;
}

/// Pictures that some texture of the plan shows, each once, as gpu::TextureUse has them. They are
/// given rows as they are asked for, and packed together at the end.
class TexelPacker {
  public:
    /// rows: the detail buffer, in which texels follow what is there.
    TexelPacker(const Scene& scene, const DetailPlan& plan, RowPages& rows)
        : scene_(scene), plan_(plan), rows_(rows), end_(rows.size()) {}

    /// gpu::TEXELS_PLAIN
    bool isPlain(const Texture& texture) const;

    uint32_t firstRowOf(const Texture& texture);

    /// Bundles of the same pictures share their rows. Of no pictures: of one white texel.
    uint32_t firstRowOf(const DetailPlan::Bundle& bundle);

    /// Packs all pictures that were asked for.
    void pack();

  private:
    class EdgedTexels;
    using TexelWords = std::array<uint32_t, 2>; ///< of a gathered texture

    /// Rows that are alike to pack: those of a line of texels, from -1 on, or of a whole picture.
    struct Lines {
        size_t firstRow, rowsOfALine;
        int64_t count;
        std::function<void(int64_t line, Row* row)> pack;
    };
    void append(Lines lines);
    void appendPlain(const std::vector<uint32_t>& words);
    void appendGathered(const TextureImage& image, bool srgb, EdgedTexels at);
    void appendBundle(const DetailPlan::EdgedBundle& bundle, EdgedTexels at, uint32_t width,
                      uint32_t height);
    /// The row of a texel of a bundle, as gpu::TEXELS_BUNDLE describes it.
    Row bundleTexel(const DetailPlan::EdgedBundle& bundle, size_t texel) const;

    const Scene& scene_;
    const DetailPlan& plan_;
    RowPages& rows_;
    size_t end_; ///< of the rows that have been given away
    std::vector<Lines> lines_;
    std::map<DetailPlan::EdgedImage, uint32_t> firstRowOfImage_, firstRowOfPlainImage_;
    std::map<DetailPlan::EdgedBundle, uint32_t> firstRowOfBundle_;
};

/// The places of texels in a picture's words, with what is seen beyond its edges.
class TexelPacker::EdgedTexels {
  public:
    EdgedTexels(const TextureImage& image, Wrap wrapU, Wrap wrapV) {
        for (int64_t x = -1; x <= int64_t(image.width); ++x)
            columns_.push_back(edged(x, image.width, wrapU));
        for (int64_t y = -1; y <= int64_t(image.height); ++y)
            lines_.push_back(size_t(edged(y, image.height, wrapV)) * image.width);
    }

    /// From -1 on. Column: place within a line of texels; line: place of its first texel.
    uint32_t column(int64_t x) const { return columns_[size_t(x + 1)]; }
    size_t line(int64_t y) const { return lines_[size_t(y + 1)]; }

  private:
    std::vector<uint32_t> columns_;
    std::vector<size_t> lines_;
};

bool TexelPacker::isPlain(const Texture& texture) const {
    return plan_.plainImages.contains(DetailPlan::EdgedImage(scene_, texture));
}

uint32_t TexelPacker::firstRowOf(const Texture& texture) {
    const TextureImage& image = scene_.images[texture.image];
    DetailPlan::EdgedImage key(scene_, texture);
    // Plain texels neither have edges nor are decoded.
    const bool plain = isPlain(texture);
    if (plain) key.wrapU = key.wrapV = Wrap::Repeat, key.srgb = false;
    auto& known = plain ? firstRowOfPlainImage_ : firstRowOfImage_;
    const auto [place, isNew] = known.try_emplace(key, uint32_t(end_));
    if (!isNew) return place->second;
    if (plain)
        appendPlain(image.words);
    else
        appendGathered(image, texture.srgb, EdgedTexels(image, texture.wrapU, texture.wrapV));
    return place->second;
}

uint32_t TexelPacker::firstRowOf(const DetailPlan::Bundle& bundle) {
    const DetailPlan::EdgedBundle edged(scene_, bundle);
    const auto [known, isNew] = firstRowOfBundle_.try_emplace(edged, uint32_t(end_));
    if (!isNew) return known->second;
    TextureImage white;
    white.width = white.height = 1;
    const TextureImage* size = &white;
    for (const uint32_t image : edged.images)
        if (image != edged.kNone) size = &scene_.images[image];
    appendBundle(edged, EdgedTexels(*size, edged.wrapU, edged.wrapV), size->width, size->height);
    return known->second;
}

void TexelPacker::append(Lines lines) {
    end_ += lines.rowsOfALine * size_t(lines.count);
    lines_.push_back(std::move(lines));
}

void TexelPacker::pack() {
    rows_.resize(end_);
    tbb::parallel_for(size_t(0), lines_.size(), [&](size_t i) {
        const Lines& lines = lines_[i];
        tbb::parallel_for(int64_t(0), lines.count, [&](int64_t line) {
            lines.pack(line - 1, rows_.data() + lines.firstRow + size_t(line) * lines.rowsOfALine);
        });
    });
}

void TexelPacker::appendPlain(const std::vector<uint32_t>& words) {
    // Whole rows: of a part of a row, texel buffers read nothing.
    append({end_, (words.size() + 3) / 4, 1, [&words](int64_t, Row* rows) {
                for (size_t i = 0; i < words.size(); ++i)
                    rows[i / 4][i % 4] = words[i];
            }});
}

void TexelPacker::appendGathered(const TextureImage& image, bool srgb, EdgedTexels at) {
    const auto texel = [&image, &color = srgb ? byteTable().linearFractions
                                              : byteTable().fractions](size_t index) -> TexelWords {
        if (image.format == TexelFormat::RgbaHalf)
            return {image.words[2 * index], image.words[2 * index + 1]};
        const uint32_t w = image.words[index];
        return {color[byteOf(w, 0)] | color[byteOf(w, 1)] << 16,
                color[byteOf(w, 2)] | byteTable().fractions[byteOf(w, 3)] << 16};
    };
    append({end_, size_t(image.width) + 2, int64_t(image.height) + 1,
            [&image, texel, at = std::move(at)](int64_t y, Row* row) {
                for (int64_t x = -1; x <= int64_t(image.width); ++x) {
                    const TexelWords upper = texel(at.line(y) + at.column(x)),
                                     lower = texel(at.line(y + 1) + at.column(x));
                    *row++ = {upper[0], upper[1], lower[0], lower[1]};
                }
            }});
}

void TexelPacker::appendBundle(const DetailPlan::EdgedBundle& bundle, EdgedTexels at,
                               uint32_t width, uint32_t height) {
    append({end_, size_t(width) + 2, int64_t(height) + 2,
            [this, bundle, at = std::move(at), width](int64_t y, Row* row) {
                for (int64_t x = -1; x <= int64_t(width); ++x)
                    *row++ = bundleTexel(bundle, at.line(y) + at.column(x));
            }});
}

Row TexelPacker::bundleTexel(const DetailPlan::EdgedBundle& bundle, size_t texel) const {
    const auto wordOf = [&](uint32_t slot) {
        const uint32_t image = bundle.images[slot];
        return image == bundle.kNone ? ~0u : scene_.images[image].words[texel];
    };
    const uint32_t color = wordOf(gpu::TEXTURE_BASE_COLOR),
                   emission = wordOf(gpu::TEXTURE_EMISSION),
                   metallicRoughness = wordOf(gpu::TEXTURE_METALLIC_ROUGHNESS);
    const auto rootOf = [](uint32_t word, uint32_t channel) {
        return byteTable().roots[byteOf(word, channel)];
    };
    const auto packed = [](uint32_t root, uint32_t nextRoot, uint32_t fraction) {
        return root | nextRoot << 12 | fraction << 24;
    };
    return {packed(rootOf(color, 0), rootOf(color, 1), byteOf(metallicRoughness, 1)),
            packed(rootOf(color, 2), rootOf(emission, 0), byteOf(metallicRoughness, 2)),
            packed(rootOf(emission, 1), rootOf(emission, 2), byteOf(color, 3)),
            wordOf(gpu::TEXTURE_NORMAL)};
}

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

gpu::TextureUse packUse(const Scene& scene, const TextureUse& use, TexelPacker& texels) {
    const Texture& texture = scene.textures[use.texture];
    const bool isHalf = scene.images[texture.image].format == TexelFormat::RgbaHalf;
    gpu::TextureUse g = packLookup(scene, use);
    g.firstRow = texels.firstRowOf(texture);
    if (texels.isPlain(texture)) g.flags |= gpu::TEXELS_PLAIN;
    g.flags |= (isHalf ? gpu::TEXELS_HALF : 0) | (texture.srgb && !isHalf ? gpu::TEXELS_SRGB : 0);
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
        appendRows(uses, packUse(scene, use, texels));
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
        if (light.picture) appendRows(rows, packUse(scene, *light.picture, texels));
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
