#include "scene/obj/material_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace stromboli::obj {
namespace {

constexpr float kDielectricIor = 1.5f;
/// What a dielectric of that index reflects at right angles: ((1.5 - 1) / (1.5 + 1))^2.
constexpr float kDielectricReflectance = 0.04f;

bool isBlack(const std::optional<glm::dvec3>& color) {
    return !color || (color->x <= 0 && color->y <= 0 && color->z <= 0);
}

class MaterialRules {
  public:
    MaterialRules(const MtlMaterial& stated, build::SceneBuilder& builder, Pictures& pictures)
        : m_(stated), builder_(builder), pictures_(pictures) {}

    Material make() {
        material_.name = m_.name;
        material_.kind = MaterialKind::Principled;
        PrincipledParameters& p = material_.principled;
        p.baseColor = baseColor();
        p.metallic = 0;
        if (hasPbrKeys())
            useMetallicRoughness();
        else if (isGlass())
            useGlass();
        else if (hasReflection())
            useReflection();
        else
            useDiffuse();
        useOpacity();
        useEmission();
        if (hasTextures()) useRelief();
        return std::move(material_);
    }

  private:
    bool hasTextures() const { return builder_.conventions().textures; }
    bool hasPbrKeys() const {
        return m_.roughness || m_.metallic || m_.sheen || m_.clearcoat || m_.clearcoatRoughness ||
               m_.anisotropy || m_.roughnessMap || m_.metallicMap || m_.specularLevel;
    }
    int illumination() const { return int(std::clamp(m_.illumination.value_or(2), 0.0, 100.0)); }
    bool isIlluminationOf(std::initializer_list<int> models) const {
        return std::find(models.begin(), models.end(), illumination()) != models.end();
    }
    /// Exporters write illum 4 for all they have, with an index of 1 where nothing is glass.
    bool isGlass() const {
        return isIlluminationOf({4, 6, 7}) && m_.ior && *m_.ior > 0 && *m_.ior != 1;
    }
    bool isMirror() const { return isIlluminationOf({3, 5, 8}); }
    /// An exponent of 0 is a highlight all over the surface: exporters write it for none.
    bool hasReflection() const {
        if (isBlack(m_.specular) || illumination() < 2) return false;
        return isMirror() || m_.exponent.value_or(0) > 0;
    }

    glm::vec3 fraction(const char* key, const glm::dvec3& color) {
        return builder_.reflectedFraction(
            fmt::format("'{}' of material '{}'", key, shortened(m_.name)), glm::vec3(color));
    }

    /// A factor that a picture multiplies: 1 if it is not stated. Black would hide the picture, and
    /// is what exporters write that think that the picture takes its place.
    glm::dvec3 factor(const char* key, const std::optional<glm::dvec3>& color, bool hasMap,
                      const glm::dvec3& otherwise) {
        if (!hasMap) return color.value_or(otherwise);
        if (color && !isBlack(color)) return *color;
        if (color)
            builder_.report().assume(
                fmt::format("'{0} 0 0 0' with a 'map_{0}' leaves the picture as it is", key));
        return glm::dvec3(1);
    }

    glm::vec3 baseColor() {
        const bool statesOther = m_.specular || m_.emission || m_.emissionMap || m_.filter;
        const glm::dvec3 otherwise(statesOther && !hasPbrKeys() ? 0.0 : 0.5);
        return fraction("Kd", factor("Kd", m_.diffuse, m_.diffuseMap && hasTextures(), otherwise));
    }

    void useDiffuse() {
        material_.kind = MaterialKind::Diffuse;
        material_.albedo = material_.principled.baseColor;
        if (!isBlack(m_.specular))
            builder_.report().ignore("'Ks' of a material",
                                     illumination() < 2
                                         ? "its 'illum' leaves it out"
                                         : "there is no exponent 'Ns' above 0 to it");
    }

    /// The highlight is the reflection of a rough dielectric that reflects Ks at right angles, as
    /// KHR_materials_specular words that of KHR_materials_pbrSpecularGlossiness.
    void useReflection() {
        PrincipledParameters& p = material_.principled;
        p.ior = kDielectricIor;
        p.specularColor = fraction("Ks", factor("Ks", m_.specular, m_.specularMap && hasTextures(),
                                                glm::dvec3(0))) /
                          kDielectricReflectance;
        p.roughness = isMirror() ? 0.0f : float(roughnessOfExponent(*m_.exponent));
        if (hasTextures() && m_.specularMap)
            use(TextureSlot::SpecularColor, *m_.specularMap, pictures_.colors(*m_.specularMap));
    }

    void useGlass() {
        PrincipledParameters& p = material_.principled;
        p.ior = index();
        p.transmission = 1;
        p.isThin = false;
        p.roughness = 0;
        p.baseColor = fraction("Tf", m_.filter.value_or(glm::dvec3(1)));
    }

    float index() {
        const double ior = *m_.ior;
        if (ior >= 1) return float(std::min(ior, 1e6));
        builder_.report().ignore("'Ni' below 1", fmt::format("{} is taken", kDielectricIor));
        return kDielectricIor;
    }

    void useMetallicRoughness() {
        PrincipledParameters& p = material_.principled;
        const auto number = [](const std::optional<double>& stated, double otherwise) {
            return float(stated.value_or(otherwise));
        };
        const bool textured = hasTextures();
        const double fromExponent = m_.exponent ? roughnessOfExponent(*m_.exponent) : 1;
        p.roughness = number(m_.roughness, textured && m_.roughnessMap ? 1 : fromExponent);
        p.metallic = number(m_.metallic, textured && m_.metallicMap ? 1 : 0);
        p.clearcoat = number(m_.clearcoat, 0);
        p.clearcoatRoughness = number(m_.clearcoatRoughness, 0);
        p.sheenColor = glm::vec3(number(m_.sheen, 0));
        // The key has no roughness; this one spreads sheen over a wide angle.
        p.sheenRoughness = 0.5f;
        p.anisotropy = number(m_.anisotropy, 0);
        p.anisotropyRotation = float(2 * std::numbers::pi) * number(m_.anisotropyRotation, 0);
        if (m_.ior && *m_.ior >= 1) p.ior = index();
        p.transmission = float(m_.transmission);
        p.isThin = m_.transmission == 0;
        if (m_.specularLevel)
            p.specularColor = builder_.lightColor("Ks", glm::vec3(*m_.specularLevel));
        if (!isBlack(m_.specular) || m_.specularMap)
            builder_.report().ignore("'Ks' of a material",
                                     "it states the metallic-roughness model ('Pr', 'Pm', ...), "
                                     "where 'Ni' says how much is reflected");
        if (textured && (m_.roughnessMap || m_.metallicMap))
            use(TextureSlot::MetallicRoughness,
                m_.roughnessMap ? *m_.roughnessMap : *m_.metallicMap,
                pictures_.roughnessMetallic(m_.roughnessMap, m_.metallicMap));
    }

    /// Opacity d, or 1 - Tr, and pictures of it. What is glass is seen through by itself.
    void useOpacity() {
        const bool textured = hasTextures();
        double opacity = m_.dissolve.value_or(1 - m_.transparency.value_or(0));
        if (!m_.dissolve && opacity == 0) { // nobody states what is not there
            builder_.report().assume("'Tr 1' without a 'd' is an opacity");
            opacity = 1;
        }
        const bool isGlassHere = material_.principled.transmission > 0;
        if (isGlassHere && (opacity < 1 || m_.opacityMap)) {
            builder_.report().ignore("'d' and 'Tr' of glass",
                                     "light goes through it as through glass");
            opacity = 1;
        }
        const bool hasMask = textured && m_.opacityMap && !isGlassHere;
        if (opacity < 1 || hasMask) {
            material_.alphaMode = AlphaMode::Blend;
            material_.opacity = float(opacity);
            if (opacity == 0)
                builder_.report().warn(
                    fmt::format("material '{}' is not seen: its opacity ('d', or "
                                "1 - 'Tr') is 0",
                                shortened(m_.name)));
        }
        // Glass has no diffuse colour for a picture to cover.
        if (!textured || isGlassHere) return;
        const bool blends = material_.alphaMode == AlphaMode::Blend;
        if (blends && (m_.diffuseMap || hasMask))
            use(TextureSlot::BaseColor, m_.diffuseMap ? *m_.diffuseMap : *m_.opacityMap,
                pictures_.colorsWithOpacity(m_.diffuseMap, m_.opacityMap));
        else if (m_.diffuseMap)
            use(TextureSlot::BaseColor, *m_.diffuseMap, pictures_.colors(*m_.diffuseMap));
    }

    /// Programs write normal maps as bumps, and their colours tell.
    void useRelief() {
        const auto useNormals = [&](const Map& map, std::optional<uint32_t> texture) {
            use(TextureSlot::Normal, map, texture, float(map.strength));
        };
        std::optional<uint32_t> bump;
        if (m_.normalMap)
            useNormals(*m_.normalMap, pictures_.normals(*m_.normalMap));
        else if (m_.bumpMap)
            useNormals(*m_.bumpMap, bump = pictures_.normalsOfBump(*m_.bumpMap));
        if (m_.bumpMap && !bump)
            builder_.report().ignore("'bump' of a material",
                                     "there are normal maps ('norm') and no bump maps");
    }

    void useEmission() {
        const bool hasMap = m_.emissionMap && hasTextures();
        if (!builder_.conventions().shadingModelsEmit) return;
        if (isBlack(m_.emission) && !hasMap) return;
        material_.emission =
            builder_.lightColor(fmt::format("'Ke' of material '{}'", shortened(m_.name)),
                                glm::vec3(factor("Ke", m_.emission, hasMap, glm::dvec3(0))));
        if (hasMap) use(TextureSlot::Emission, *m_.emissionMap, pictures_.colors(*m_.emissionMap));
    }

    /// In the file v grows upwards, on the renderer's pictures downwards: v' = 1 - v. With
    /// s v + o in place of v, 1 - (s (1 - v') + o) = s v' + 1 - s - o.
    void use(TextureSlot slot, const Map& map, std::optional<uint32_t> texture,
             float strength = 1) {
        if (!texture) return;
        TextureUse use;
        use.slot = slot;
        use.texture = *texture;
        use.uRow = {map.scale.x, 0, map.offset.x};
        use.vRow = {0, map.scale.y, 1 - map.scale.y - map.offset.y};
        use.scale = strength;
        material_.textures.push_back(use);
    }

    const MtlMaterial& m_;
    build::SceneBuilder& builder_;
    Pictures& pictures_;
    Material material_;
};

} // namespace

double roughnessOfExponent(double exponent) {
    const double alphaSquared = 2 / (std::max(exponent, 0.0) + 2);
    return std::pow(alphaSquared, 0.25);
}

Material materialOf(const MtlMaterial& stated, build::SceneBuilder& builder, Pictures& pictures) {
    return MaterialRules(stated, builder, pictures).make();
}

} // namespace stromboli::obj
