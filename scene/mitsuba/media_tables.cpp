#include "scene/mitsuba/media_tables.hpp"

#include "scene/build/metals.hpp"
#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/upgrade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

namespace stromboli::mitsuba {
namespace {

struct NamedIndex {
    std::string_view name;
    double value;
};

/// Mitsuba's documentation has the same table.
constexpr NamedIndex kIndices[] = {
    {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.5750},      {"diamond", 2.419}};

template <class Table>
std::string namesOf(const Table& table) {
    std::string names;
    for (const auto& row : table)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
    return names;
}

double indexOfName(const Plugin& plugin, std::string_view parameter, const std::string& name) {
    for (const NamedIndex& row : kIndices)
        if (row.name == inSmallLetters(name)) return row.value;
    plugin.replaceParameter(
        parameter, build::Shortfall::Word,
        fmt::format("is '{}', expected a number or one of {}", name, namesOf(kIndices)));
    return 0;
}

bool isNamedMetal(std::string_view name) {
    return std::ranges::any_of(build::namedMetals(),
                               [&](const build::NamedMetal& row) { return row.name == name; });
}

MetalIndex metalNamed(const Plugin& plugin, const std::string& name) {
    for (const build::NamedMetal& row : build::namedMetals())
        if (row.name == name) return row.index;
    for (const build::NamedMetal& row : build::namedMetals())
        if (inSmallLetters(row.name) == inSmallLetters(name)) return row.index;
    // Mitsuba 0.x has two tables of some metals, those of one of them with a name that ends so.
    constexpr std::string_view kSecondTable = "_palik";
    std::string instead =
        name.ends_with(kSecondTable) ? name.substr(0, name.size() - kSecondTable.size()) : "Cu";
    if (!isNamedMetal(instead)) instead = "Cu";
    plugin.replace(build::Shortfall::Model,
                   fmt::format("'material' is '{}', expected one of {}, or eta and k", name,
                               namesOf(build::namedMetals())),
                   instead);
    return metalNamed(plugin, instead);
}

} // namespace

double refractiveIndex(const Plugin& plugin, std::string_view name, std::string_view otherwise) {
    const Value* value = plugin.find(name);
    double index = 0;
    if (value && std::holds_alternative<std::string>(*value))
        index = indexOfName(plugin, name, *plugin.text(name));
    else if (value)
        index = plugin.number(name, 1e-3, 1e3).value_or(0);
    return index > 0 ? index : indexOfName(plugin, name, std::string(otherwise));
}

/// Part of an index of refraction. Programs that make three channels of spectra write some below 0,
/// which would reflect more than all light.
static std::optional<glm::dvec3> partOfIndex(const Plugin& plugin, const char* name) {
    const std::optional<glm::dvec3> part = colorOf(plugin, name, ColorOf::Index);
    if (!part) return std::nullopt;
    for (const int channel : {0, 1, 2})
        if ((*part)[channel] < 0) {
            plugin.replaceParameter(name, build::Shortfall::Number,
                                    fmt::format("is {}, expected 0 or more", (*part)[channel]));
            break;
        }
    return glm::max(*part, 0.0);
}

MetalIndex metalIndex(const Plugin& plugin) {
    const std::optional<std::string> name = plugin.text("material");
    const std::optional<glm::dvec3> eta = partOfIndex(plugin, "eta");
    const std::optional<glm::dvec3> k = partOfIndex(plugin, "k");
    for (const char* parameter : {"eta", "k"})
        if (plugin.child(parameter) && !(eta && k))
            plugin.replaceParameter(parameter, build::Shortfall::Word,
                                    "is a texture, expected a colour");
    if (name && *name != "none" && (eta || k))
        plugin.replaceParameter("material", build::Shortfall::Parameter,
                                "is stated beside eta or k, expected one of both");
    // A conductor that says nothing is copper in Mitsuba 0.x.
    const bool isCopper = plugin.isOld && !name && !eta && !k;
    const bool isNamed = name && !eta && !k;
    MetalIndex metal = isCopper  ? metalNamed(plugin, "Cu")
                       : isNamed ? metalNamed(plugin, *name)
                                 : MetalIndex{};
    if (eta) metal.eta = *eta;
    if (k) metal.k = *k;
    // Relative to what is outside, as the indices of dielectrics are.
    const double outside = refractiveIndex(plugin, "ext_eta", plugin.isOld ? "air" : "vacuum");
    return {metal.eta / outside, metal.k / outside};
}

} // namespace stromboli::mitsuba
