#include "scene/model/material.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

/// The least parameter that the material's microfacets can have.
float leastAlpha(const Material& m) {
    if (m.kind != MaterialKind::Dielectric) return kLeastAlpha;
    // Between equal indices it is infinite: such an interface changes nothing, rough or not.
    const float step = std::abs(m.ior - 1);
    return std::max(kLeastAlpha, kLeastRefractionAlpha * std::max(m.ior, 1.0f) / step);
}

glm::vec2 statedAlpha(const Material& m) {
    return m.kind == MaterialKind::Plastic ? glm::vec2(m.facets.alpha.x) : m.facets.alpha;
}

} // namespace

glm::vec3 PrincipledParameters::absorption() const {
    constexpr float kLeastTransmitted = 1e-30f;
    return -glm::log(glm::max(attenuationColor, glm::vec3(kLeastTransmitted))) /
           attenuationDistance;
}

bool PrincipledParameters::isClear() const {
    return transmission >= 1 && roughness <= 0 && metallic <= 0 && anisotropy <= 0 &&
           clearcoat <= 0 && sheenColor == glm::vec3(0) && iridescence <= 0 && dispersion <= 0 &&
           diffuseTransmission <= 0;
}

float PrincipledParameters::indexSpread() const {
    // The definition of the Abbe number, (n_d - 1) / (n_F - n_C), of which dispersion is 20 over.
    return isThin || ior <= 1 ? 0 : (ior - 1) * dispersion / 40;
}

bool BurleyParameters::transmits() const {
    if (isThin) return transmission > 0 || diffuseTransmission > 0;
    return transmission > 0 && metallic < 1;
}

float BurleyParameters::usedIor() const {
    constexpr float kLeastStep = 0x1p-10f; // LEAST_INDEX_STEP
    if (isThin || transmission == 0 || std::abs(ior - 1) >= kLeastStep) return ior;
    return ior < 1 ? 1 - kLeastStep : 1 + kLeastStep;
}

float BurleyParameters::leastAlpha() const {
    constexpr float kMitsubas = 1e-3f;
    if (isThin || transmission == 0) return kMitsubas;
    const float used = usedIor();
    return std::max(kMitsubas, kLeastRefractionAlpha * std::max(used, 1.0f) / std::abs(used - 1));
}

bool Material::isDelta() const {
    switch (kind) {
    case MaterialKind::Mirror:
    case MaterialKind::Refraction:
    case MaterialKind::ThinDielectric:
        return true;
    case MaterialKind::Conductor:
    case MaterialKind::Dielectric:
    case MaterialKind::Principled:
        return isSmooth();
    default:
        return false;
    }
}

bool Material::entersVolume() const {
    switch (kind) {
    case MaterialKind::Refraction:
    case MaterialKind::Dielectric:
        return true;
    case MaterialKind::Principled:
        return !principled.isThin &&
               (principled.transmission > 0 || principled.diffuseTransmission > 0);
    case MaterialKind::Burley:
        return !burley.isThin && burley.transmits();
    default:
        return false;
    }
}

bool Material::isSmooth() const {
    if (kind == MaterialKind::Principled)
        return principled.isClear() && std::ranges::none_of(textures, [](const TextureUse& t) {
                   return t.slot == TextureSlot::Transmission;
               });
    const glm::vec2 stated = statedAlpha(*this);
    return !(std::max(stated.x, stated.y) >= leastAlpha(*this));
}

glm::vec2 Material::facetAlpha() const {
    return glm::max(statedAlpha(*this), glm::vec2(leastAlpha(*this)));
}

bool Material::hasGrain() const {
    if (kind == MaterialKind::Principled) return principled.anisotropy > 0;
    if (kind == MaterialKind::Burley) return burley.anisotropy > 0;
    const bool canHave = kind == MaterialKind::Conductor || kind == MaterialKind::Dielectric;
    if (!canHave || isSmooth()) return false;
    const auto isRoughness = [](const TextureUse& t) {
        return t.slot == TextureSlot::MetallicRoughness; // a number for either direction
    };
    return facets.alpha.x != facets.alpha.y || std::ranges::any_of(textures, isRoughness);
}

glm::vec3* Material::baseColor() {
    switch (kind) {
    case MaterialKind::Diffuse:
    case MaterialKind::Plastic:
        return &albedo;
    case MaterialKind::Principled:
        return &principled.baseColor;
    case MaterialKind::Burley:
        return &burley.baseColor;
    case MaterialKind::Conductor:
        return &reflectance;
    case MaterialKind::ThinDielectric:
        return &transmittance;
    case MaterialKind::Dielectric: // smooth, it is the same as glass
        return isSmooth() ? nullptr : &transmittance;
    default:
        return nullptr;
    }
}

} // namespace stromboli
