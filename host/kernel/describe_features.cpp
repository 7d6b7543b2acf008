#include "host/kernel/kernel_features.hpp"

#include <fmt/format.h>

#include <bit>

namespace stromboli {
namespace {

FeatureValue bits(std::vector<const char*> names) {
    return {FeatureValue::Kind::Bits, std::move(names)};
}
FeatureValue oneOf(std::vector<const char*> names) {
    return {FeatureValue::Kind::Choice, std::move(names)};
}
FeatureValue count(const char* unit) {
    return {FeatureValue::Kind::Count, {unit}};
}
const FeatureValue flag = {FeatureValue::Kind::Flag, {}};
const FeatureValue share = {FeatureValue::Kind::Share, {}};

/// By TEXTURE_ slot.
const std::vector<const char*> kTextureSlots = {"base color",
                                                "metallic-roughness",
                                                "normal",
                                                "emission",
                                                "transmission",
                                                "specular",
                                                "specular color",
                                                "clearcoat",
                                                "clearcoat roughness",
                                                "clearcoat normal",
                                                "sheen color",
                                                "sheen roughness",
                                                "anisotropy",
                                                "height",
                                                "share of a mixture",
                                                "of a projector",
                                                "opacity"};

/// By LOBE_ bit, and behind these by closure bit (shaders/shared/bsdf_types.h).
const std::vector<const char*> kLobes = {"diffuse reflection",  "glossy reflection",
                                         "mirror reflection",   "diffuse transmission",
                                         "glossy transmission", "clear transmission"};
const std::vector<const char*> kClosures = [] {
    std::vector<const char*> names = kLobes;
    for (const char* name :
         {"diffuse base", "interface", "base under an interface", "clear coat", "sheen",
          "smooth interface", "conductor", "dielectric", "ideal interface", "refraction",
          "thin sheet", "Beckmann's microfacets", "separable masking", "turned grain",
          "base that deepens", "absorption", "base color", "glTF's recipe", "Burley's recipe"})
        names.push_back(name);
    return names;
}();

std::string list(uint32_t bits, const std::vector<const char*>& names) {
    std::string text;
    for (uint32_t i = 0; i < names.size(); ++i)
        if (bits & (1u << i)) text += (text.empty() ? "" : ", ") + std::string(names[i]);
    return text;
}

} // namespace

const std::vector<Feature>& featureTable() {
#define FEATURE_ROW(number, type, name, standard, value, all, label, shown, adds)                  \
    {SPEC_##name, #name, label, shown, adds},
    static const std::vector<Feature> table = {KERNEL_FEATURES(FEATURE_ROW)};
#undef FEATURE_ROW
    return table;
}

std::string valueText(const Feature& feature, uint32_t value) {
    const std::vector<const char*>& names = feature.shown.names;
    switch (feature.shown.kind) {
    case FeatureValue::Kind::Choice:
        return names.at(value);
    case FeatureValue::Kind::Flag:
        return value != 0 ? "" : "none";
    case FeatureValue::Kind::Bits:
        return value != 0 ? list(value, names) : "none";
    case FeatureValue::Kind::Count:
        if (value == 0) return "none";
        return fmt::format("{}{}{}", value, *names[0] ? " " : "", names[0]);
    case FeatureValue::Kind::Share:
        return value != 0 ? fmt::format("{:.0f} %", 100 * double(std::bit_cast<float>(value)))
                          : "none";
    }
    return "";
}

std::vector<std::string> describe(const KernelFeatures& features) {
    std::vector<std::string> lines;
    for (const Feature& f : featureTable()) {
        const uint32_t value = features[f.constant];
        const bool isThere = value != 0 || f.shown.kind == FeatureValue::Kind::Choice;
        const std::string text = valueText(f, value);
        if (isThere) lines.push_back(text.empty() ? f.label : fmt::format("{}: {}", f.label, text));
    }
    return lines;
}

} // namespace stromboli
