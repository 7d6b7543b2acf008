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
/// three channels publish them (the table of the renderer Tungsten). Extinctions that come out
/// below 0 are 0; AlSb, whose index does, is left out.
const NamedMetal kMetals[] = {
    {"none", {}},
    {"Ag", {{0.155275, 0.116723, 0.138342}, {4.828372, 3.122499, 2.147037}}},
    {"Al", {{1.657460, 0.880369, 0.521229}, {9.223869, 6.269523, 4.837001}}},
    {"Au", {{0.143119, 0.374957, 1.442479}, {3.983160, 2.385721, 1.603215}}},
    {"Cu", {{0.200438, 0.924033, 1.102212}, {3.912949, 2.452848, 2.142188}}},
    {"a-C", {{2.9441, 2.22715, 1.968167}, {0.887433, 0.799322, 0.815286}}},
    {"AlAs", {{3.605102, 3.232937, 2.217561}, {0.000667, 0.0, 0.007426}}},
    {"Be", {{4.185059, 3.18506, 2.784091}, {3.83544, 3.010126, 2.869009}}},
    {"Cr", {{4.369683, 2.916702, 1.654701}, {5.206434, 4.231365, 3.754947}}},
    {"CsI", {{2.144903, 1.702316, 1.662419}, {0.0, 0.0, 0.0}}},
    {"Cu2O", {{3.549283, 2.952062, 2.73692}, {0.113218, 0.194666, 0.600168}}},
    {"CuO", {{3.245382, 2.449629, 2.197411}, {0.520274, 0.570737, 0.717225}}},
    {"d-C", {{2.711252, 2.318581, 2.228857}, {0.0, 0.0, 0.0}}},
    {"Hg", {{2.398931, 1.440025, 0.909551}, {6.327627, 4.371941, 3.42179}}},
    {"HgTe", {{4.779527, 3.230998, 2.660025}, {1.631983, 1.580819, 1.729575}}},
    {"Ir", {{3.08641, 2.082194, 1.617887}, {5.592151, 4.067176, 3.267261}}},
    {"K", {{0.064049, 0.04641, 0.038184}, {2.104216, 1.348936, 0.913211}}},
    {"Li", {{0.265787, 0.19561, 0.22092}, {3.540174, 2.311131, 1.668593}}},
    {"MgO", {{2.089589, 1.650722, 1.594876}, {0.0, 0.0, 0.0}}},
    {"Mo", {{4.483701, 3.525458, 2.776077}, {4.111131, 3.420872, 3.150603}}},
    {"Na", {{0.060267, 0.056141, 0.061991}, {3.179291, 2.11248, 1.579094}}},
    {"Nb", {{3.420135, 2.790192, 2.395586}, {3.441382, 2.737644, 2.579913}}},
    {"Ni", {{2.367275, 1.663358, 1.467055}, {4.498833, 3.050164, 2.345427}}},
    {"Rh", {{2.585795, 1.860187, 1.554428}, {6.782293, 4.70295, 3.976089}}},
    {"Se-e", {{5.724272, 4.165399, 4.08161}, {0.871375, 1.105285, 1.564779}}},
    {"Se", {{4.059261, 2.842695, 2.820758}, {0.754379, 0.638515, 0.521587}}},
    {"SiC", {{3.172345, 2.525968, 2.479362}, {0.0, 0.0, 1e-05}}},
    {"SnTe", {{4.525187, 1.981153, 1.281682}, {0.0, 0.0, 0.0}}},
    {"Ta", {{2.062585, 2.393092, 2.628068}, {2.408047, 1.741371, 1.947038}}},
    {"Te-e", {{7.50904, 4.29646, 2.369873}, {5.584208, 4.947623, 3.997515}}},
    {"Te", {{7.39084, 4.482103, 2.637071}, {3.256141, 3.527391, 3.292168}}},
    {"ThF4", {{1.830719, 1.442227, 1.387649}, {0.0, 0.0, 0.0}}},
    {"TiC", {{3.700467, 2.837436, 2.582303}, {3.265691, 2.351559, 2.172786}}},
    {"TiN", {{1.648469, 1.150448, 1.37978}, {3.36846, 1.943489, 1.102012}}},
    {"TiO2-e", {{3.106557, 2.513155, 2.582384}, {2.9e-05, 0.0, 0.000178}}},
    {"TiO2", {{3.45662, 2.801708, 2.905149}, {0.000103, 0.0, 0.000636}}},
    {"VC", {{3.657567, 2.75273, 2.532681}, {3.068352, 2.198669, 1.963182}}},
    {"VN", {{2.865601, 2.119182, 1.940077}, {3.032326, 2.056108, 1.616293}}},
    {"V", {{4.277513, 3.513154, 2.761126}, {3.491184, 2.889358, 3.111697}}},
    {"W", {{4.370703, 3.300297, 2.998267}, {3.500678, 2.604865, 2.273193}}},
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
    plugin.replaceParameter(
        parameter, build::Shortfall::Word,
        fmt::format("is '{}', expected a number or one of {}", name, namesOf(kIndices)));
    return 0;
}

MetalIndex metalNamed(const Plugin& plugin, const std::string& name) {
    for (const NamedMetal& row : kMetals)
        if (row.name == name) return row.index;
    for (const NamedMetal& row : kMetals)
        if (inSmallLetters(row.name) == inSmallLetters(name)) return row.index;
    plugin.replace(
        build::Shortfall::Model,
        fmt::format("'material' is '{}', expected one of {}, or eta and k", name, namesOf(kMetals)),
        "Cu");
    return metalNamed(plugin, "Cu");
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
