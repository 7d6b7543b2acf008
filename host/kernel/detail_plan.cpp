#include "host/kernel/detail_plan.hpp"

#include "shaders/shared/interface.h"
#include "shaders/shared/texture_types.h"

#include <algorithm>

namespace stromboli {
namespace {

bool isBlack(const glm::vec3& color) {
    return color == glm::vec3(0);
}

/// Whether a texture in this slot can change what the material is.
bool hasEffect(const Material& m, TextureSlot slot) {
    const bool isPrincipled = m.kind == MaterialKind::Principled;
    const bool hasFacets =
        (m.kind == MaterialKind::Conductor || m.kind == MaterialKind::Dielectric) && !m.isSmooth();
    const bool hasReflectance = m.kind == MaterialKind::ThinDielectric ||
                                m.kind == MaterialKind::Plastic ||
                                (m.kind == MaterialKind::Dielectric && hasFacets);
    if (slot == TextureSlot::Opacity) return m.alphaMode != AlphaMode::Opaque;
    if (slot == TextureSlot::BlendShare) return m.other != kNoMaterial && m.otherShare > 0;
    if (m.kind == MaterialKind::Burley) return slot != TextureSlot::ClearcoatNormal;
    const PrincipledParameters& p = m.principled;
    switch (slot) {
    case TextureSlot::BaseColor:
        return m.alphaMode != AlphaMode::Opaque ||
               (m.baseColor() != nullptr && !isBlack(*m.baseColor()));
    case TextureSlot::Emission:
        return m.emits();
    case TextureSlot::Normal:
    case TextureSlot::Height:
        return m.kind != MaterialKind::Diffuse || !isBlack(m.albedo);
    case TextureSlot::MetallicRoughness:
        return hasFacets || (isPrincipled && (p.metallic > 0 || p.roughness > 0));
    case TextureSlot::Transmission:
        return isPrincipled && p.transmission > 0;
    case TextureSlot::Specular:
        return isPrincipled && p.specular > 0;
    case TextureSlot::SpecularColor:
        return (hasReflectance && !isBlack(m.reflectance)) ||
               (isPrincipled && p.specular > 0 && !isBlack(p.specularColor));
    case TextureSlot::Clearcoat:
        return isPrincipled && p.clearcoat > 0;
    case TextureSlot::ClearcoatRoughness:
        return isPrincipled && p.clearcoat > 0 && p.clearcoatRoughness > 0;
    case TextureSlot::ClearcoatNormal:
        return isPrincipled && p.clearcoat > 0;
    case TextureSlot::SheenColor:
        return isPrincipled && !isBlack(p.sheenColor);
    case TextureSlot::SheenRoughness:
        return isPrincipled && !isBlack(p.sheenColor) && p.sheenRoughness > 0;
    case TextureSlot::Anisotropy:
        return isPrincipled && p.anisotropy > 0;
    case TextureSlot::DiffuseTransmission:
        return isPrincipled && p.diffuseTransmission > 0;
    case TextureSlot::DiffuseTransmissionColor:
        return isPrincipled && p.diffuseTransmission > 0 && !isBlack(p.diffuseTransmissionColor);
    case TextureSlot::Iridescence:
        return isPrincipled && p.iridescence > 0;
    case TextureSlot::FilmThickness:
        return isPrincipled && p.iridescence > 0 && p.filmSpan != 0;
    case TextureSlot::BlendShare: // above
    case TextureSlot::Opacity:    // likewise
    case TextureSlot::Projection: // of lights
        return false;
    }
    return false;
}

constexpr uint32_t kOne = 0x3C00; // as a half float

bool isOpaque(const TextureImage& image) {
    if (image.format == TexelFormat::Rgba8)
        return std::ranges::all_of(image.words, [](uint32_t w) { return w >> 24 == 0xFF; });
    for (size_t i = 1; i < image.words.size(); i += 2)
        if (image.words[i] >> 16 != kOne) return false;
    return true;
}

/// Whether the half floats of a picture are fractions of 65,535 as exactly: the rounding of one is
/// at most that of a half float from 2^-6 on. Of smaller ones only alpha counts by its difference,
/// 2^-17 here, and not by its ratio.
bool areFractions(const TextureImage& image) {
    constexpr uint32_t kLeast = 0x2400; // 2^-6
    const auto isColor = [](uint32_t half) {
        return half == 0 || (half >= kLeast && half <= kOne);
    };
    if (image.format != TexelFormat::RgbaHalf) return false;
    for (size_t i = 0; i + 1 < image.words.size(); i += 2) {
        const uint32_t low = image.words[i], high = image.words[i + 1];
        if (!isColor(low & 0xFFFF) || !isColor(low >> 16) || !isColor(high & 0xFFFF) ||
            high >> 16 > kOne)
            return false;
    }
    return true;
}

/// Whether fractions hold a picture's opacities, which are red.
bool hasFractionsOfOpacity(const TextureImage& image) {
    if (image.format != TexelFormat::RgbaHalf) return true;
    for (size_t i = 0; i < image.words.size(); i += 2)
        if ((image.words[i] & 0xFFFF) > kOne) return false;
    return true;
}

class Planner {
  public:
    /// fewestMaps: that a bundle has.
    Planner(const Scene& scene, uint64_t gatheredRows, uint32_t fewestMaps)
        : scene_(scene), fewestMaps_(fewestMaps), rowsLeft_(gatheredRows) {
        constexpr glm::vec4 white(1);
        for (const VertexAttributes& a : scene.attributes) {
            hasColors_ |= a.color != white;
            hasTransparentColors_ |= a.color.a != 1;
        }
    }

    DetailPlan plan(const std::vector<bool>& used) {
        plan_.materials.resize(scene_.materials.size());
        for (size_t i = 0; i < scene_.materials.size(); ++i)
            if (used[i] && scene_.materials[i].alphaMode == AlphaMode::Mask)
                noteCutOut(scene_.materials[i]);
        for (size_t i = 0; i < scene_.materials.size(); ++i)
            if (used[i]) add(scene_.materials[i], plan_.materials[i]);
        for (const Light& light : scene_.lights)
            if (light.picture) addPicture(*light.picture);
        if (scene_.attributeCorners.empty()) plan_.attributes = 0;
        plan_.hasTangentFrames &= plan_.attributes != 0;
        return std::move(plan_);
    }

  private:
    void add(const Material& m, DetailPlan::MaterialPlan& material) {
        material.isTransparent = isTransparent(m);
        material.isHidden = m.isHiddenFromCamera;
        plan_.hasAlpha |= material.isTransparent || material.isHidden;
        plan_.hasHidden |= material.isHidden;
        material.isBlend = m.other != kNoMaterial && m.otherShare > 0;
        plan_.hasBlends |= material.isBlend;
        for (const TextureUse& use : m.textures)
            if (hasEffect(m, use.slot)) material.textures.push_back(use);
        std::ranges::sort(material.textures, {}, &TextureUse::slot);
        for (const TextureUse& use : material.textures)
            material.coatHasNormal |=
                use.slot == TextureSlot::Normal || use.slot == TextureSlot::ClearcoatNormal;
        material.coatHasNormal &= m.kind == MaterialKind::Principled && m.principled.clearcoat > 0;
        takeOutBundle(material);
        if (material.bundle) {
            plan_.texelKinds |= gpu::TEXEL_KIND_BUNDLE;
            for (const auto& map : *material.bundle)
                if (map) addTexture(*map);
        }
        takeOutOpacity(material);
        for (const TextureUse& use : material.textures) {
            addTexture(use);
            addLoose(use, use.slot == TextureSlot::BaseColor ? material.opacity : std::nullopt);
            plan_.looseSlots |= 1u << uint32_t(use.slot);
        }
        plan_.mostTextures = std::max(plan_.mostTextures, uint32_t(material.textures.size()));
        if (hasColors_ && (m.baseColor() != nullptr || material.isTransparent))
            plan_.attributes |= gpu::ATTRIBUTE_COLOR;
        if (m.hasGrain()) {
            plan_.attributes |= gpu::ATTRIBUTE_TANGENT;
            plan_.hasTangentFrames = true;
        }
    }

    /// Adds the picture of a light, which has texture coordinates of its own.
    void addPicture(const TextureUse& use) {
        const uint32_t before = plan_.attributes;
        addTexture(use);
        plan_.attributes = before;
        addLoose(use, std::nullopt);
    }

    /// Adds a texture that is in no bundle. opacity: that its texels hold.
    void addLoose(const TextureUse& use, const std::optional<TextureUse>& opacity) {
        if (opacity) {
            plan_.texelKinds |=
                gpu::TEXEL_KIND_LOOSE | gpu::TEXEL_KIND_BYTES | gpu::TEXEL_KIND_GATHERED;
            return;
        }
        const Texture& texture = scene_.textures[use.texture];
        const DetailPlan::EdgedImage edged(scene_, texture);
        if (!gathered_.contains(edged) && !plan_.plainImages.contains(edged)) {
            (takeRows(edgedTexels(texture, 1)) ? gathered_ : plan_.plainImages).insert(edged);
            if (mayBeFractions(use)) plan_.fractionImages.insert(texture.image);
        }
        const bool isPlain = plan_.plainImages.contains(edged);
        const bool isHalf = plan_.isHalf(scene_, texture);
        plan_.texelKinds |= gpu::TEXEL_KIND_LOOSE;
        plan_.texelKinds |= isHalf ? gpu::TEXEL_KIND_HALF : gpu::TEXEL_KIND_BYTES;
        plan_.texelKinds |= isPlain ? gpu::TEXEL_KIND_PLAIN : gpu::TEXEL_KIND_GATHERED;
        if (isPlain && edged.srgb) plan_.texelKinds |= gpu::TEXEL_KIND_SRGB;
    }

    void addTexture(const TextureUse& use) {
        const Texture& texture = scene_.textures[use.texture];
        plan_.textureSlots |= 1u << uint32_t(use.slot);
        plan_.texelKinds |= texture.nearest ? gpu::TEXEL_KIND_NEAREST : gpu::TEXEL_KIND_BILINEAR;
        for (const Wrap wrap : {texture.wrapU, texture.wrapV})
            plan_.texelKinds |= gpu::TEXEL_KIND_REPEAT << uint32_t(wrap);
        const bool isMoved = use.uRow != glm::vec3(1, 0, 0) || use.vRow != glm::vec3(0, 1, 0);
        if (isMoved || use.scale != 1) plan_.texelKinds |= gpu::TEXEL_KIND_ADJUSTED;
        plan_.attributes |= use.uvSet == 0 ? gpu::ATTRIBUTE_UV0 : gpu::ATTRIBUTE_UV1;
        if (use.slot == TextureSlot::Normal || use.slot == TextureSlot::ClearcoatNormal)
            plan_.attributes |= gpu::ATTRIBUTE_TANGENT;
    }

    /// Two pictures or more that are looked up alike cost as many loads as one if they are bundled,
    /// or fewer. Of several such groups, the largest.
    void takeOutBundle(DetailPlan::MaterialPlan& material) {
        DetailPlan::Bundle bundle;
        ptrdiff_t maps = 0;
        for (const TextureUse& like : material.textures) {
            const auto isAlike = [&](const TextureUse& use) {
                return isBundled(like) && isBundled(use) && areLookedUpAlike(use, like);
            };
            const ptrdiff_t alike = std::ranges::count_if(material.textures, isAlike);
            if (alike <= maps) continue;
            bundle = {}, maps = alike;
            for (const TextureUse& use : material.textures)
                if (isAlike(use)) bundle[uint32_t(use.slot)] = use;
        }
        if (maps < ptrdiff_t(fewestMaps_) || !hasRoomFor(bundle)) return;
        material.bundle = bundle;
        std::erase_if(material.textures, [&](const TextureUse& use) {
            const uint32_t slot = uint32_t(use.slot);
            return slot < bundle.size() && bundle[slot] && bundle[slot]->texture == use.texture;
        });
    }

    /// An opacity that is looked up as the base colour is, which has none, becomes the alpha of its
    /// texels: one lookup for two. Leaves are cut out of their pictures so.
    void takeOutOpacity(DetailPlan::MaterialPlan& material) {
        std::vector<TextureUse>& textures = material.textures;
        const auto color = std::ranges::find(textures, TextureSlot::BaseColor, &TextureUse::slot);
        const auto opacity = std::ranges::find(textures, TextureSlot::Opacity, &TextureUse::slot);
        if (color == textures.end() || opacity == textures.end()) return;
        if (!areLookedUpAlike(*color, *opacity) || !isOpaque(imageOf(*color))) return;
        if (isCutOut(*opacity) || !hasFractionsOfOpacity(imageOf(*opacity))) return;
        if (imageOf(*color).format == TexelFormat::RgbaHalf && !areFractions(imageOf(*color)))
            return;
        const DetailPlan::EdgedImage key(scene_, *color, *opacity);
        if (!gathered_.contains(key) && !takeRows(edgedTexels(scene_.textures[color->texture], 1)))
            return;
        gathered_.insert(key);
        material.opacity = *opacity;
        textures.erase(opacity);
    }

    /// A mask compares opacities with its cutoff, which may be one of them: half floats stay.
    void noteCutOut(const Material& m) {
        for (const TextureUse& use : m.textures)
            if (use.slot == TextureSlot::BaseColor || use.slot == TextureSlot::Opacity)
                cutOut_.insert(scene_.textures[use.texture].image);
    }
    bool isCutOut(const TextureUse& use) const {
        return imageOf(use).format == TexelFormat::RgbaHalf &&
               cutOut_.contains(scene_.textures[use.texture].image);
    }
    bool mayBeFractions(const TextureUse& use) const {
        return !isCutOut(use) && areFractions(imageOf(use));
    }

    bool isBundled(const TextureUse& use) const {
        if (uint32_t(use.slot) >= gpu::BUNDLE_MAPS) return false;
        const Texture& texture = scene_.textures[use.texture];
        const bool isColor =
            use.slot == TextureSlot::BaseColor || use.slot == TextureSlot::Emission;
        return texture.srgb == isColor && scene_.images[texture.image].format == TexelFormat::Rgba8;
    }

    bool areLookedUpAlike(const TextureUse& a, const TextureUse& b) const {
        const Texture &s = scene_.textures[a.texture], &t = scene_.textures[b.texture];
        const TextureImage &i = scene_.images[s.image], &j = scene_.images[t.image];
        return i.width == j.width && i.height == j.height && s.wrapU == t.wrapU &&
               s.wrapV == t.wrapV && s.nearest == t.nearest && a.uvSet == b.uvSet &&
               a.uRow == b.uRow && a.vRow == b.vRow;
    }

    const TextureImage& imageOf(const TextureUse& use) const {
        return scene_.images[scene_.textures[use.texture].image];
    }

    /// Materials may share a bundle.
    bool hasRoomFor(const DetailPlan::Bundle& bundle) {
        const DetailPlan::EdgedBundle key(scene_, bundle);
        if (bundles_.contains(key)) return true;
        const auto some =
            std::ranges::find_if(bundle, [](const auto& map) { return map.has_value(); });
        if (!takeRows(edgedTexels(scene_.textures[(*some)->texture], 2))) return false;
        bundles_.insert(key);
        return true;
    }

    /// Texels of the picture and of those beyond its edges: two columns, and so many lines
    /// (gpu::TextureUse).
    uint64_t edgedTexels(const Texture& texture, uint64_t linesBeyond) const {
        const TextureImage& image = scene_.images[texture.image];
        return (uint64_t(image.width) + 2) * (image.height + linesBeyond);
    }

    bool takeRows(uint64_t rows) {
        if (rows > rowsLeft_) return false;
        rowsLeft_ -= rows;
        return true;
    }

    bool isTransparent(const Material& m) const {
        if (m.alphaMode == AlphaMode::Opaque) return false;
        if (m.opacity != 1 || hasTransparentColors_) return true;
        if (m.alphaMode == AlphaMode::Mask && m.alphaCutoff > 1) return true;
        for (const TextureUse& use : m.textures)
            if (use.slot == TextureSlot::Opacity ||
                (use.slot == TextureSlot::BaseColor &&
                 !isOpaque(scene_.images[scene_.textures[use.texture].image])))
                return true;
        return false;
    }

    const Scene& scene_;
    uint32_t fewestMaps_;
    bool hasColors_ = false, hasTransparentColors_ = false;
    uint64_t rowsLeft_;         ///< for textures that are not stored plainly
    std::set<uint32_t> cutOut_; ///< pictures of opacities of masks
    std::set<DetailPlan::EdgedImage> gathered_;
    std::set<DetailPlan::EdgedBundle> bundles_;
    DetailPlan plan_;
};

} // namespace

bool DetailPlan::isHalf(const Scene& scene, const Texture& texture) const {
    return scene.images[texture.image].format == TexelFormat::RgbaHalf &&
           (plainImages.contains(EdgedImage(scene, texture)) ||
            !fractionImages.contains(texture.image));
}

DetailPlan::EdgedBundle::EdgedBundle(const Scene& scene, const Bundle& bundle) {
    images.fill(kNone);
    for (uint32_t i = 0; i < images.size(); ++i) {
        if (!bundle[i]) continue;
        const Texture& texture = scene.textures[bundle[i]->texture];
        images[i] = texture.image;
        wrapU = texture.wrapU, wrapV = texture.wrapV;
    }
}

DetailPlan planDetails(const Scene& scene, const std::vector<bool>& used, uint64_t gatheredRows) {
    static_assert(kTextureSlotCount == gpu::TEXTURE_SLOT_COUNT);
#define COMPARE_SLOT(name, slot, number, label)                                                    \
    static_assert(uint32_t(TextureSlot::slot) == gpu::TEXTURE_##name);
    TEXTURE_SLOT_LIST(COMPARE_SLOT)
#undef COMPARE_SLOT
    static_assert(uint32_t(Wrap::Repeat) == gpu::WRAP_REPEAT);
    static_assert(uint32_t(Wrap::Mirror) == gpu::WRAP_MIRROR);
    static_assert(uint32_t(Wrap::Clamp) == gpu::WRAP_CLAMP);
    static_assert(gpu::TEXEL_KIND_MIRROR == gpu::TEXEL_KIND_REPEAT << gpu::WRAP_MIRROR);
    static_assert(gpu::TEXEL_KIND_CLAMP == gpu::TEXEL_KIND_REPEAT << gpu::WRAP_CLAMP);
    static_assert(uint32_t(OtherPlace::Behind) == gpu::OTHER_BEHIND);
    static_assert(uint32_t(OtherPlace::InFront) == gpu::OTHER_IN_FRONT);
    DetailPlan plan = Planner(scene, gatheredRows, 2).plan(used);
    // Where all lanes look up a bundle anyway, a picture by itself costs less in one than as a
    // loose texture: nothing, or four loads for a lookup's two and all of its code.
    if (plan.hasBundles() && plan.looseSlots != 0)
        plan = Planner(scene, gatheredRows, 1).plan(used);
    return plan;
}

} // namespace stromboli
