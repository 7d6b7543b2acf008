// Materials by the names of their kinds and parameters: the members of scene/model/material.hpp.
#include "host/api/named_materials.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace stromboli::api {
namespace {

struct Kind {
    const char* name;
    MaterialKind kind;
};
constexpr Kind kKinds[] = {
    {"diffuse", MaterialKind::Diffuse},
    {"mirror", MaterialKind::Mirror},
    {"refraction", MaterialKind::Refraction},
    {"principled", MaterialKind::Principled},
    {"conductor", MaterialKind::Conductor},
    {"dielectric", MaterialKind::Dielectric},
    {"thin_dielectric", MaterialKind::ThinDielectric},
    {"plastic", MaterialKind::Plastic},
    {"burley", MaterialKind::Burley},
};

constexpr uint32_t bit(MaterialKind kind) {
    return 1u << uint32_t(kind);
}
template <class... Kinds>
constexpr uint32_t of(Kinds... kinds) {
    return (bit(kinds) | ...);
}
using K = MaterialKind;
constexpr uint32_t kAll = 0xFFFFFFFFu;
constexpr double kAny = 1e30;

/// The numbers that a parameter is: `count` floats from `values` on, each from least to most.
/// `flag` in place of them where it is a yes or no.
struct Parameter {
    const char* name;
    uint32_t kinds;
    int count;
    double least, most;
    const char* meaning;
    float* (*values)(Material&);
    bool* (*flag)(Material&);
};

#define NUMBERS(member) [](Material& m) -> float* { return &m.member; }, nullptr
#define COLOUR(member) [](Material& m) -> float* { return &m.member.x; }, nullptr
#define FLAG(member) nullptr, [](Material& m) -> bool* { return &m.member; }
constexpr Parameter kParameters[] = {
    {"emission", kAll, 3, 0, kAny, "radiance that it emits, W / (sr m^2)", COLOUR(emission)},
    {"emits_both_sides", kAll, 1, 0, 1, "or only to where its normal points", FLAG(emitsBothSides)},
    {"albedo", of(K::Diffuse, K::Plastic), 3, 0, 1, "share of light reflected diffusely",
     COLOUR(albedo)},
    {"reflectance", of(K::Mirror, K::Conductor, K::Dielectric, K::ThinDielectric, K::Plastic), 3, 0,
     1, "a factor of what is reflected", COLOUR(reflectance)},
    {"transmittance", of(K::Refraction, K::Dielectric, K::ThinDielectric), 3, 0, 1,
     "a factor of what is transmitted", COLOUR(transmittance)},
    {"ior", of(K::Refraction, K::Dielectric, K::ThinDielectric, K::Plastic), 1, 1e-3, 1e3,
     "index inside / index outside", NUMBERS(ior)},
    {"eta", of(K::Conductor), 3, 0, 1e3, "real part of the index", COLOUR(eta)},
    {"k", of(K::Conductor), 3, 0, 1e3, "extinction coefficient", COLOUR(k)},
    {"alpha", of(K::Conductor, K::Dielectric, K::Plastic), 2, 0, 1e3,
     "roughness of its facets along the tangent and across; 0: smooth", COLOUR(facets.alpha)},
    {"nonlinear", of(K::Plastic), 1, 0, 1, "the colour deepens with reflections inside",
     FLAG(isNonlinear)},

    {"base_color", of(K::Principled), 3, 0, 1, "colour", COLOUR(principled.baseColor)},
    {"metallic", of(K::Principled), 1, 0, 1, "share of metal", NUMBERS(principled.metallic)},
    {"roughness", of(K::Principled), 1, 0, 1, "glTF's: the root of alpha",
     NUMBERS(principled.roughness)},
    {"ior", of(K::Principled), 1, 1, 1e3, "index inside / index outside", NUMBERS(principled.ior)},
    {"specular", of(K::Principled), 1, 0, 1, "strength of the dielectric reflection",
     NUMBERS(principled.specular)},
    {"specular_color", of(K::Principled), 3, 0, kAny, "its colour",
     COLOUR(principled.specularColor)},
    {"clearcoat", of(K::Principled), 1, 0, 1, "strength of a clear coat",
     NUMBERS(principled.clearcoat)},
    {"clearcoat_roughness", of(K::Principled), 1, 0, 1, "its roughness",
     NUMBERS(principled.clearcoatRoughness)},
    {"sheen_color", of(K::Principled), 3, 0, 1, "colour of cloth's sheen",
     COLOUR(principled.sheenColor)},
    {"sheen_roughness", of(K::Principled), 1, 0, 1, "its roughness",
     NUMBERS(principled.sheenRoughness)},
    {"anisotropy", of(K::Principled), 1, 0, 1, "strength", NUMBERS(principled.anisotropy)},
    {"anisotropy_rotation", of(K::Principled), 1, -1e3, 1e3,
     "radians from the tangent to the bitangent", NUMBERS(principled.anisotropyRotation)},
    {"transmission", of(K::Principled), 1, 0, 1, "share of light that passes",
     NUMBERS(principled.transmission)},
    {"thin", of(K::Principled), 1, 0, 1, "no volume behind the surface", FLAG(principled.isThin)},
    {"attenuation_color", of(K::Principled), 3, 0, 1, "what is left of light after the distance",
     COLOUR(principled.attenuationColor)},
    {"attenuation_distance", of(K::Principled), 1, 1e-30, std::numeric_limits<double>::infinity(),
     "metres", NUMBERS(principled.attenuationDistance)},
    {"diffuse_transmission", of(K::Principled), 1, 0, 1,
     "share of what is diffuse that goes to the other side",
     NUMBERS(principled.diffuseTransmission)},
    {"diffuse_transmission_color", of(K::Principled), 3, 0, 1, "its colour",
     COLOUR(principled.diffuseTransmissionColor)},
    {"dispersion", of(K::Principled), 1, 0, 1e3, "of the volume: 20 / Abbe number",
     NUMBERS(principled.dispersion)},
    {"iridescence", of(K::Principled), 1, 0, 1, "strength of interference in a thin film",
     NUMBERS(principled.iridescence)},
    {"film_ior", of(K::Principled), 1, 1, 1e3, "index of the film", NUMBERS(principled.filmIor)},
    {"film_thickness", of(K::Principled), 1, 0, 1e6, "nanometres",
     NUMBERS(principled.filmThickness)},

    {"base_color", of(K::Burley), 3, 0, 1, "colour", COLOUR(burley.baseColor)},
    {"metallic", of(K::Burley), 1, 0, 1, "share of metal", NUMBERS(burley.metallic)},
    {"roughness", of(K::Burley), 1, 0, 1, "the root of alpha", NUMBERS(burley.roughness)},
    {"anisotropy", of(K::Burley), 1, 0, 1, "strength", NUMBERS(burley.anisotropy)},
    {"ior", of(K::Burley), 1, 1e-3, 1e3, "index inside / index outside", NUMBERS(burley.ior)},
    {"specular_tint", of(K::Burley), 1, 0, 1, "colour of reflections",
     NUMBERS(burley.specularTint)},
    {"transmission", of(K::Burley), 1, 0, 1, "share of light that passes",
     NUMBERS(burley.transmission)},
    {"sheen", of(K::Burley), 1, 0, 1, "of cloth", NUMBERS(burley.sheen)},
    {"sheen_tint", of(K::Burley), 1, 0, 1, "its colour", NUMBERS(burley.sheenTint)},
    {"flatness", of(K::Burley), 1, 0, 1, "towards scattering under the surface",
     NUMBERS(burley.flatness)},
    {"clearcoat", of(K::Burley), 1, 0, 1, "strength of a clear coat", NUMBERS(burley.clearcoat)},
    {"clearcoat_gloss", of(K::Burley), 1, 0, 1, "how smooth it is", NUMBERS(burley.clearcoatGloss)},
    {"thin", of(K::Burley), 1, 0, 1, "without volume, metal and coat", FLAG(burley.isThin)},
    {"diffuse_transmission", of(K::Burley), 1, 0, 1, "thin: share of the diffuse",
     NUMBERS(burley.diffuseTransmission)},
};
#undef NUMBERS
#undef COLOUR
#undef FLAG

const Parameter& parameterOf(const Material& material, std::string_view parameter) {
    std::vector<std::string_view> names;
    for (const Parameter& row : kParameters) {
        if ((row.kinds & bit(material.kind)) == 0) continue;
        if (row.name == parameter) return row;
        names.emplace_back(row.name);
    }
    throw UsageError(fmt::format("a {} material has no '{}': expected one of {}", kindOf(material),
                                 parameter, fmt::join(names, ", ")));
}

} // namespace

Material makeMaterial(std::string_view kind, std::string name) {
    for (const Kind& row : kKinds) {
        if (row.name != kind) continue;
        Material material;
        material.kind = row.kind;
        material.name = std::move(name);
        return material;
    }
    throw UsageError(fmt::format("there is no material of the kind '{}': expected one of {}", kind,
                                 fmt::join(materialKinds(), ", ")));
}

void setMaterial(Material& material, std::string_view parameter, const Value& value) {
    const Parameter& row = parameterOf(material, parameter);
    const std::string numbers =
        row.count == 1 ? "a number" : fmt::format("{} numbers, or one for all", row.count);
    const auto refuse = [&] {
        throw UsageError(fmt::format("{} of a {} material: expected {} from {:g} to {:g}",
                                     parameter, kindOf(material), numbers, row.least, row.most));
    };
    const auto* all = std::get_if<std::vector<double>>(&value);
    if (!all || (all->size() != 1 && all->size() != size_t(row.count))) refuse();
    for (const double number : *all)
        if (!(number >= row.least && number <= row.most)) refuse();
    if (row.flag) {
        *row.flag(material) = all->front() != 0;
        return;
    }
    float* values = row.values(material);
    for (int i = 0; i < row.count; ++i)
        values[i] = float((*all)[all->size() == 1 ? 0 : size_t(i)]);
}

std::vector<double> materialValue(const Material& material, std::string_view parameter) {
    const Parameter& row = parameterOf(material, parameter);
    Material copy = material;
    if (row.flag) return {*row.flag(copy) ? 1.0 : 0.0};
    const float* values = row.values(copy);
    return {values, values + row.count};
}

std::vector<std::string> materialKinds() {
    std::vector<std::string> names;
    for (const Kind& row : kKinds)
        names.emplace_back(row.name);
    return names;
}

std::string_view kindOf(const Material& material) {
    return std::ranges::find(kKinds, material.kind, &Kind::kind)->name;
}

std::vector<NamedThing> materialParameters(std::string_view kind) {
    const Material material = makeMaterial(kind, {});
    std::vector<NamedThing> result;
    for (const Parameter& row : kParameters)
        if (row.kinds & bit(material.kind)) result.push_back({row.name, row.meaning});
    return result;
}

} // namespace stromboli::api
