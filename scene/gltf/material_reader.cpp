#include "scene/gltf/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::gltf {

namespace {
constexpr double kNoMaximum = std::numeric_limits<double>::infinity();
} // namespace

Material MaterialReader::read() {
    material_.name = at_.displayName();
    material_.kind = MaterialKind::Principled;
    readBase();
    readSpecularGlossiness();
    readAlpha();
    readEmission();
    readTransmission();
    readSpecular();
    readClearcoat();
    readSheen();
    readAnisotropy();
    readDiffuseTransmission();
    readDispersion();
    readIridescence();
    useNormalMap(at_, "normalTexture", TextureSlot::Normal);
    if (at_.extension("KHR_materials_unlit")) makeUnlit();
    reportIgnored();
    return std::move(material_);
}

/// A number that the format confines to [0, 1].
double MaterialReader::fraction(const Element& at, std::string_view member,
                                double otherwise) const {
    const double value = at.number(member, otherwise);
    const double inside = std::clamp(value, 0.0, 1.0);
    if (inside != value)
        context_.report().warn(
            fmt::format("{}.{}: a fraction outside [0, 1] is clamped to it", at.path(), member));
    return inside;
}

glm::vec3 MaterialReader::color(const Element& at, std::string_view member,
                                const glm::vec3& otherwise) const {
    return context_.builder.reflectedFraction(fmt::format("{}.{}", at.path(), member),
                                              at.vector(member, otherwise));
}

void MaterialReader::use(const Element& parent, std::string_view member, TextureSlot slot,
                         bool srgb) {
    if (const auto found = textures_.use(parent, member, slot, srgb, uvSets_))
        material_.textures.push_back(*found);
}

void MaterialReader::useNormalMap(const Element& parent, std::string_view member,
                                  TextureSlot slot) {
    const size_t before = material_.textures.size();
    use(parent, member, slot);
    if (material_.textures.size() > before)
        material_.textures.back().scale = float(parent.child(member)->number("scale", 1));
}

void MaterialReader::readBase() {
    const std::optional<Element> pbr = at_.child("pbrMetallicRoughness");
    if (!pbr) return;
    PrincipledParameters& p = material_.principled;
    const std::vector<double> base = pbr->numbersOr("baseColorFactor", 4);
    if (!base.empty()) {
        p.baseColor = context_.builder.reflectedFraction(pbr->path() + ".baseColorFactor",
                                                         glm::vec3(base[0], base[1], base[2]));
        material_.opacity = float(std::clamp(base[3], 0.0, 1.0));
    }
    p.metallic = float(fraction(*pbr, "metallicFactor", 1));
    p.roughness = float(fraction(*pbr, "roughnessFactor", 1));
    use(*pbr, "baseColorTexture", TextureSlot::BaseColor, true);
    use(*pbr, "metallicRoughnessTexture", TextureSlot::MetallicRoughness);
}

void MaterialReader::readAlpha() {
    const std::string mode = at_.text("alphaMode", "OPAQUE");
    if (mode == "MASK")
        material_.alphaMode = AlphaMode::Mask;
    else if (mode == "BLEND")
        material_.alphaMode = AlphaMode::Blend;
    else if (mode != "OPAQUE")
        at_.forgive(build::Shortfall::Word, "alphaMode",
                    fmt::format("is '{}', expected OPAQUE, MASK or BLEND", mode));
    material_.alphaCutoff = float(at_.number("alphaCutoff", 0.5, 0, kNoMaximum));
}

void MaterialReader::readEmission() {
    double strength = 1;
    if (const auto extension = at_.extension("KHR_materials_emissive_strength"))
        strength = extension->number("emissiveStrength", 1, 0, kNoMaximum);
    material_.emission = context_.builder.lightColor(
        at_.path() + ".emissiveFactor", strength * at_.vector("emissiveFactor", glm::dvec3(0)));
    if (material_.emits()) use(at_, "emissiveTexture", TextureSlot::Emission, true);
}

void MaterialReader::readTransmission() {
    PrincipledParameters& p = material_.principled;
    if (const auto extension = at_.extension("KHR_materials_transmission")) {
        p.transmission = float(fraction(*extension, "transmissionFactor", 0));
        use(*extension, "transmissionTexture", TextureSlot::Transmission);
    }
    if (const auto extension = at_.extension("KHR_materials_volume")) {
        // How thick the volume is the geometry says; the number only says that there is one.
        p.isThin = extension->number("thicknessFactor", 0, 0, kNoMaximum) == 0;
        p.attenuationColor = color(*extension, "attenuationColor", glm::vec3(1));
        const double distance = extension->number("attenuationDistance", kNoMaximum);
        if (distance > 0)
            p.attenuationDistance = float(distance);
        else
            extension->forgive(build::Shortfall::Word, "attenuationDistance",
                               fmt::format("is {}, expected more than 0", distance));
        if (!p.isThin) readScattering();
    }
}

/// The colour that so dense a medium has after any number of scatterings says how much is scattered
/// at each: C. Kulla and A. Conty, "Revisiting Physically Based Shading at Imageworks", 2017. What
/// the volume takes from a ray is its extinction then.
void MaterialReader::readScattering() {
    const auto extension = at_.extension("KHR_materials_volume_scatter");
    if (!extension) return;
    const glm::dvec3 many(color(*extension, "multiscatterColor", glm::vec3(0)));
    const double asymmetry = extension->number("scatterAnisotropy", 0, -1, 1);
    const glm::dvec3 extinction(material_.principled.absorption());
    if (many == glm::dvec3(0) || extinction == glm::dvec3(0)) return;
    Medium medium;
    medium.name = material_.name;
    medium.asymmetry =
        float(std::clamp(asymmetry, -double(kMostAsymmetry), double(kMostAsymmetry)));
    for (int c = 0; c < 3; ++c) {
        const double root = std::sqrt(9.59217 + 41.6808 * many[c] + 17.7126 * many[c] * many[c]);
        const double s = 4.09712 + 4.20863 * many[c] - root;
        const double albedo = std::clamp(1 - s * s, 0.0, 1.0);
        medium.scattering[c] = float(extinction[c] * albedo);
        medium.absorption[c] = float(extinction[c] * (1 - albedo));
    }
    material_.boundsMedia = true;
    material_.outsideIsOpen = true;
    material_.inside = context_.builder.addMedium(std::move(medium));
}

void MaterialReader::readSpecular() {
    PrincipledParameters& p = material_.principled;
    if (const auto extension = at_.extension("KHR_materials_ior")) {
        const double ior = extension->number("ior", 1.5);
        // Materials of specular and glossiness are converted so: all is reflected, but for what the
        // specular colour takes away, as by an index without end.
        constexpr float kEndless = 1e4f;
        if (ior != 0)
            p.ior = float(std::max(ior, 1.0));
        else if (p.transmission == 0)
            p.ior = kEndless;
        else
            context_.report().ignore("an index of refraction of 0 of what lets light through",
                                     "1.5 is taken");
        if (ior != 0 && ior < 1)
            extension->forgive(build::Shortfall::Number, "ior",
                               fmt::format("is {}, expected 0 or at least 1", ior));
    }
    if (const auto extension = at_.extension("KHR_materials_specular")) {
        p.specular = float(fraction(*extension, "specularFactor", 1));
        // May exceed 1: what it multiplies is small.
        p.specularColor =
            context_.builder.lightColor(extension->path() + ".specularColorFactor",
                                        extension->vector("specularColorFactor", glm::dvec3(1)));
        use(*extension, "specularTexture", TextureSlot::Specular);
        use(*extension, "specularColorTexture", TextureSlot::SpecularColor, true);
    }
}

void MaterialReader::readClearcoat() {
    const auto extension = at_.extension("KHR_materials_clearcoat");
    if (!extension) return;
    PrincipledParameters& p = material_.principled;
    p.clearcoat = float(fraction(*extension, "clearcoatFactor", 0));
    p.clearcoatRoughness = float(fraction(*extension, "clearcoatRoughnessFactor", 0));
    if (p.clearcoat == 0) return;
    use(*extension, "clearcoatTexture", TextureSlot::Clearcoat);
    use(*extension, "clearcoatRoughnessTexture", TextureSlot::ClearcoatRoughness);
    useNormalMap(*extension, "clearcoatNormalTexture", TextureSlot::ClearcoatNormal);
}

void MaterialReader::readSheen() {
    const auto extension = at_.extension("KHR_materials_sheen");
    if (!extension) return;
    PrincipledParameters& p = material_.principled;
    p.sheenColor = color(*extension, "sheenColorFactor", glm::vec3(0));
    p.sheenRoughness = float(fraction(*extension, "sheenRoughnessFactor", 0));
    if (p.sheenColor == glm::vec3(0)) return;
    use(*extension, "sheenColorTexture", TextureSlot::SheenColor, true);
    use(*extension, "sheenRoughnessTexture", TextureSlot::SheenRoughness);
}

void MaterialReader::readAnisotropy() {
    const auto extension = at_.extension("KHR_materials_anisotropy");
    if (!extension) return;
    PrincipledParameters& p = material_.principled;
    p.anisotropy = float(fraction(*extension, "anisotropyStrength", 0));
    p.anisotropyRotation = float(extension->number("anisotropyRotation", 0));
    if (p.anisotropy > 0) use(*extension, "anisotropyTexture", TextureSlot::Anisotropy);
}

void MaterialReader::readDiffuseTransmission() {
    const auto extension = at_.extension("KHR_materials_diffuse_transmission");
    if (!extension) return;
    PrincipledParameters& p = material_.principled;
    p.diffuseTransmission = float(fraction(*extension, "diffuseTransmissionFactor", 0));
    p.diffuseTransmissionColor = color(*extension, "diffuseTransmissionColorFactor", glm::vec3(1));
    if (p.diffuseTransmission == 0) return;
    use(*extension, "diffuseTransmissionTexture", TextureSlot::DiffuseTransmission);
    use(*extension, "diffuseTransmissionColorTexture", TextureSlot::DiffuseTransmissionColor, true);
}

void MaterialReader::readDispersion() {
    const auto extension = at_.extension("KHR_materials_dispersion");
    if (!extension) return;
    PrincipledParameters& p = material_.principled;
    const double dispersion = extension->number("dispersion", 0, 0, kNoMaximum);
    if (p.isThin && dispersion > 0)
        context_.report().ignore("KHR_materials_dispersion of a material without a volume",
                                 "light goes straight through it");
    else
        p.dispersion = float(dispersion);
}

void MaterialReader::readIridescence() {
    const auto extension = at_.extension("KHR_materials_iridescence");
    if (!extension) return;
    PrincipledParameters& p = material_.principled;
    p.iridescence = float(fraction(*extension, "iridescenceFactor", 0));
    if (p.iridescence == 0) return;
    p.filmIor = float(extension->number("iridescenceIor", 1.3, 1, kNoMaximum));
    const double least = extension->number("iridescenceThicknessMinimum", 100, 0, kNoMaximum);
    const double most = extension->number("iridescenceThicknessMaximum", 400, 0, kNoMaximum);
    p.filmThickness = float(most);
    use(*extension, "iridescenceTexture", TextureSlot::Iridescence);
    const size_t before = material_.textures.size();
    use(*extension, "iridescenceThicknessTexture", TextureSlot::FilmThickness);
    if (material_.textures.size() == before) return;
    p.filmThickness = float(least);
    p.filmSpan = float(most - least);
}

/// The older model, whose names the newer one has for all it says: a dielectric whose reflectance
/// at right angles is the specular colour, and which scatters back what is left of the light.
void MaterialReader::readSpecularGlossiness() {
    const auto extension = at_.extension("KHR_materials_pbrSpecularGlossiness");
    if (!extension) return;
    PrincipledParameters& p = material_.principled;
    p = {};
    std::erase_if(material_.textures, [](const TextureUse&) { return true; });
    const std::vector<double> diffuse = extension->numbersOr("diffuseFactor", 4);
    if (!diffuse.empty()) {
        p.baseColor = context_.builder.reflectedFraction(
            extension->path() + ".diffuseFactor", glm::vec3(diffuse[0], diffuse[1], diffuse[2]));
        material_.opacity = float(std::clamp(diffuse[3], 0.0, 1.0));
    }
    constexpr float reflectance = 0.04f; // of ior 1.5 at right angles
    p.metallic = 0;
    const double glossiness = fraction(*extension, "glossinessFactor", 1);
    const glm::vec3 specular = color(*extension, "specularFactor", glm::vec3(1));
    p.roughness = float(1 - glossiness);
    p.specularColor = specular / reflectance;
    use(*extension, "diffuseTexture", TextureSlot::BaseColor, true);
    if (extension->has("specularGlossinessTexture"))
        readSpecularGlossinessTexture(*extension, glossiness);
    context_.report().assume("KHR_materials_pbrSpecularGlossiness is taken as a dielectric of that "
                             "specular colour");
}

void MaterialReader::readSpecularGlossinessTexture(const Element& extension, double glossiness) {
    constexpr std::string_view member = "specularGlossinessTexture";
    PrincipledParameters& p = material_.principled;
    const auto colors = textures_.use(extension, member, TextureSlot::SpecularColor, true, uvSets_);
    if (!colors) {
        // Factors of a picture that is not there are mostly 1, which would be a mirror.
        p.specularColor = glm::vec3(1);
        p.roughness = 1;
        return;
    }
    material_.textures.push_back(*colors);
    if (const auto rough = textures_.useGlossiness(extension, member, glossiness, uvSets_)) {
        material_.textures.push_back(*rough);
        p.roughness = 1;
    }
}

/// A colour that is shown as it is, whatever the light: it is emitted, and nothing is reflected.
void MaterialReader::makeUnlit() {
    material_.kind = MaterialKind::Diffuse;
    material_.albedo = glm::vec3(0);
    material_.emission = material_.principled.baseColor;
    std::erase_if(material_.textures,
                  [](const TextureUse& use) { return use.slot != TextureSlot::BaseColor; });
    if (!material_.textures.empty()) {
        TextureUse shown = material_.textures.front();
        shown.slot = TextureSlot::Emission;
        // Its alpha is still the opacity.
        if (material_.alphaMode == AlphaMode::Opaque) material_.textures.clear();
        material_.textures.push_back(shown);
    }
    context_.report().assume("unlit materials (KHR_materials_unlit) emit their colour, and light "
                             "what is around them");
}

void MaterialReader::reportIgnored() {
    if (at_.has("occlusionTexture"))
        context_.report().ignore("occlusion textures", "what they foretell is computed");
}

} // namespace stromboli::gltf
