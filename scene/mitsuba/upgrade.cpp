#include "scene/mitsuba/upgrade.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace stromboli::mitsuba {

std::string upgradedName(std::string_view name) {
    std::string upgraded;
    bool afterSmall = false;
    for (const char c : name) {
        const bool isCapital = std::isupper(static_cast<unsigned char>(c)) != 0;
        if (isCapital && afterSmall) upgraded += '_';
        upgraded += isCapital ? char(std::tolower(static_cast<unsigned char>(c))) : c;
        afterSmall = std::islower(static_cast<unsigned char>(c)) != 0;
    }
    return upgraded;
}

std::string inSmallLetters(std::string_view type) {
    std::string name(type);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return name;
}

std::string ancientName(std::string_view tag, std::string_view type, std::string_view name) {
    if (tag == "emitter" && name == "intensity") {
        if (type == "area" || type == "constant") return "radiance";
        if (type == "directional") return "irradiance";
    }
    if (tag == "shape" && type == "cylinder" && (name == "p1" || name == "p2"))
        return name == "p1" ? "p0" : "p1";
    if (tag == "bsdf" && name == "ior" && type == "roughconductor") return "eta";
    for (const auto& [old, later] : {std::pair{"intensityScale", "scale"},
                                     {"densityMultiplier", "scale"},
                                     {"sizeMultiplier", "scale"},
                                     {"focusDepth", "focusDistance"},
                                     {"inverted", "flipNormals"},
                                     {"alphaB", "alpha"},
                                     {"alphaX", "alphaU"},
                                     {"alphaY", "alphaV"},
                                     {"brightColor", "color0"},
                                     {"darkColor", "color1"},
                                     {"luminaireSamples", "emitterSamples"}})
        if (name == old) return later;
    return std::string(name);
}

std::string upgradedType(std::string_view tag, std::string_view type) {
    struct Renamed {
        std::string_view tag, old, later;
    };
    constexpr Renamed kRenamed[] = {
        {"film", "ldrfilm", "hdrfilm"},           {"film", "mfilm", "hdrfilm"},
        {"film", "tiledhdrfilm", "hdrfilm"},      {"film", "exrfilm", "hdrfilm"},
        {"film", "pngfilm", "hdrfilm"},           {"integrator", "volpath_simple", "volpath"},
        {"integrator", "errctrl", "adaptive"},    {"bsdf", "bump", "bumpmap"},
        {"bsdf", "lambertian", "diffuse"},        {"bsdf", "microfacet", "roughplastic"},
        {"bsdf", "roughmetal", "roughconductor"}, {"bsdf", "roughglass", "roughdielectric"},
        {"bsdf", "mirror", "conductor"},          {"bsdf", "composite", "mixturebsdf"},
        {"texture", "exrtexture", "bitmap"},      {"texture", "ldrtexture", "bitmap"},
    };
    for (const Renamed& r : kRenamed)
        if (r.tag == tag && r.old == type) return std::string(r.later);
    return std::string(type);
}

} // namespace stromboli::mitsuba
