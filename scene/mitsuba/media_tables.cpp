#include "scene/mitsuba/media_tables.hpp"

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

struct NamedMetal {
    std::string_view name;
    MetalIndex index;
};

/// Measured spectra under the CIE 1931 curves, in Rec. 709 primaries, as renderers that work in
/// three channels publish them.
const NamedMetal kMetals[] = {
    {"none", {}},
    {"Ag", {{0.155275, 0.116723, 0.138342}, {4.828372, 3.122499, 2.147037}}},
    {"Al", {{1.657460, 0.880369, 0.521229}, {9.223869, 6.269523, 4.837001}}},
    {"Au", {{0.143119, 0.374957, 1.442479}, {3.983160, 2.385721, 1.603215}}},
    {"Cu", {{0.200438, 0.924033, 1.102212}, {3.912949, 2.452848, 2.142188}}},
};

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
    plugin.fail(parameter,
                fmt::format("is '{}', expected a number or one of {}", name, namesOf(kIndices)));
}

MetalIndex metalNamed(const Plugin& plugin, const std::string& name) {
    for (const NamedMetal& row : kMetals)
        if (row.name == name) return row.index;
    plugin.fail("material",
                fmt::format("is '{}', expected one of {}, or eta and k", name, namesOf(kMetals)));
}

} // namespace

double refractiveIndex(const Plugin& plugin, std::string_view name, std::string_view otherwise) {
    const Value* value = plugin.find(name);
    if (!value || std::holds_alternative<std::string>(*value))
        return indexOfName(plugin, name, value ? *plugin.text(name) : std::string(otherwise));
    return *plugin.number(name, 1e-3, 1e3);
}

MetalIndex metalIndex(const Plugin& plugin) {
    const std::optional<std::string> name = plugin.text("material");
    const std::optional<glm::dvec3> eta = colorOf(plugin, "eta", ColorOf::Index);
    const std::optional<glm::dvec3> k = colorOf(plugin, "k", ColorOf::Index);
    for (const char* parameter : {"eta", "k"})
        if (plugin.child(parameter) && !(eta && k))
            plugin.fail(parameter, "is a texture, expected a colour");
    MetalIndex metal = name ? metalNamed(plugin, *name) : MetalIndex{};
    if (name && *name != "none" && (eta || k))
        plugin.fail("material", "is stated beside eta or k, expected one of both");
    if (eta) metal.eta = *eta;
    if (k) metal.k = *k;
    // Relative to what is outside, as the indices of dielectrics are.
    const double outside = refractiveIndex(plugin, "ext_eta", "vacuum");
    return {metal.eta / outside, metal.k / outside};
}

} // namespace stromboli::mitsuba
