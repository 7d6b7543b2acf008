#include "scene/pbrt/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace stromboli::pbrt {
namespace {

/// A kind that a directive names, and the version that has it.
struct Sign {
    std::string_view directive, kind;
    Version version;
};

constexpr Sign kSigns[] = {
    {"WorldEnd", "", Version::V3},
    {"TransformBegin", "", Version::V3},
    {"Attribute", "", Version::V4},
    {"ColorSpace", "", Version::V4},
    {"Option", "", Version::V4},
    {"SurfaceIntegrator", "", Version::V3},
    {"Film", "image", Version::V3},
    {"Film", "rgb", Version::V4},
    {"Film", "gbuffer", Version::V4},
    {"Film", "spectral", Version::V4},
    {"Integrator", "directlighting", Version::V3},
    {"Integrator", "whitted", Version::V3},
    {"Integrator", "simplepath", Version::V4},
    {"Integrator", "simplevolpath", Version::V4},
    {"Integrator", "lightpath", Version::V4},
    {"Integrator", "randomwalk", Version::V4},
    {"Sampler", "02sequence", Version::V3},
    {"Sampler", "lowdiscrepancy", Version::V3},
    {"Sampler", "maxmindist", Version::V3},
    {"Sampler", "random", Version::V3},
    {"Sampler", "independent", Version::V4},
    {"Sampler", "paddedsobol", Version::V4},
    {"Sampler", "pmj02bn", Version::V4},
    {"Sampler", "zsobol", Version::V4},
    {"Camera", "environment", Version::V3},
    {"Camera", "spherical", Version::V4},
    {"Shape", "heightfield", Version::V3},
    {"Shape", "nurbs", Version::V3},
    {"Shape", "cone", Version::V3},
    {"Shape", "hyperboloid", Version::V3},
    {"Shape", "paraboloid", Version::V3},
    {"Shape", "bilinearmesh", Version::V4},
    {"Texture", "uv", Version::V3},
    {"Texture", "directionmix", Version::V4},
};

constexpr std::array<std::string_view, 14> kMaterials3 = {
    "matte",  "plastic",     "metal", "mirror", "glass",        "uber",    "substrate",
    "disney", "translucent", "none",  "",       "kdsubsurface", "fourier", "shinymetal"};
constexpr std::array<std::string_view, 9> kMaterials4 = {
    "diffuse",        "coateddiffuse", "coatedconductor",     "conductor", "dielectric",
    "thindielectric", "measured",      "diffusetransmission", "interface"};

template <size_t N>
bool holds(const std::array<std::string_view, N>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

/// The version that a material tells, whose kind stands behind the directive or in a parameter.
std::optional<Version> versionOfMaterial(const Statement& s) {
    std::string_view kind;
    if (s.directive() == "Material" && !s.words.empty()) {
        kind = s.words.front();
    } else if (s.directive() == "MakeNamedMaterial") {
        const auto type = std::ranges::find(s.parameters, "type", &Parameter::name);
        if (type == s.parameters.end() || type->words.empty()) return std::nullopt;
        kind = type->words.front();
    } else {
        return std::nullopt;
    }
    if (holds(kMaterials3, kind)) return Version::V3;
    if (holds(kMaterials4, kind)) return Version::V4;
    return std::nullopt;
}

std::optional<Version> versionOfParameter(const Statement& s, const Parameter& p) {
    if (p.type == "color" || p.type == "point" || p.type == "vector" || p.type == "xyz")
        return Version::V3;
    const bool isLight = s.directive() == "LightSource";
    if (isLight && p.name == "mapname") return Version::V3;
    if (isLight && (p.name == "filename" || p.name == "illuminance" || p.name == "power"))
        return Version::V4;
    return std::nullopt;
}

std::optional<Version> versionOf(const Statement& s) {
    if (const std::optional<Version> version = versionOfMaterial(s)) return version;
    // The kind of a texture is its third word, and its class the second one.
    const bool isTexture = s.directive() == "Texture" && s.words.size() == 3;
    if (isTexture && s.words[1] == "color") return Version::V3;
    const std::string_view kind = isTexture         ? std::string_view(s.words[2])
                                  : s.words.empty() ? std::string_view()
                                                    : std::string_view(s.words.front());
    for (const Sign& sign : kSigns)
        if (sign.directive == s.directive() && (sign.kind.empty() || sign.kind == kind))
            return sign.version;
    for (const Parameter& parameter : s.parameters)
        if (const std::optional<Version> version = versionOfParameter(s, parameter)) return version;
    return std::nullopt;
}

} // namespace

VersionFound versionOf(const std::vector<Statement>& statements) {
    size_t votes[2] = {0, 0};
    std::string signs[2];
    for (const Statement& s : statements) {
        const std::optional<Version> version = versionOf(s);
        if (!version) continue;
        const auto which = size_t(*version);
        if (votes[which]++ > 0) continue;
        signs[which] = s.place.describe(s.words.empty() ? "stands there"
                                                        : fmt::format("'{}'", s.words.back()));
    }
    const Version version = votes[0] > votes[1] ? Version::V3 : Version::V4;
    return {version, signs[size_t(version)]};
}

} // namespace stromboli::pbrt
