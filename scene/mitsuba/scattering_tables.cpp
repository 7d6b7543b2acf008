#include "scene/mitsuba/scattering_tables.hpp"

#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/upgrade.hpp"

#include <fmt/format.h>

#include <string_view>

namespace stromboli::mitsuba {
namespace {

struct NamedMedium {
    std::string_view name;
    Scattering scattering;
};

/// H. W. Jensen, S. R. Marschner, M. Levoy and P. Hanrahan, "A Practical Model for Subsurface Light
/// Transport", 2001, figure 5: reduced scattering and absorption.
const NamedMedium kMedia[] = {
    {"skin1", {{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}}},
    {"skin2", {{1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}}},
    {"apple", {{2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}}},
    {"chicken1", {{0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}}},
    {"chicken2", {{0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}}},
    {"cream", {{7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}}},
    {"ketchup", {{0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}}},
    {"marble", {{2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}}},
    {"potato", {{0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}}},
    {"skimmilk", {{0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}}},
    {"wholemilk", {{2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}}},
    {"spectralon", {{11.6, 20.4, 14.9}, {0, 0, 0}}},
};

} // namespace

glm::dvec3 Scattering::albedo() const {
    glm::dvec3 result(0.0);
    for (const int c : {0, 1, 2})
        if (extinction()[c] > 0) result[c] = scattered[c] / extinction()[c];
    return result;
}

Scattering scatteringOf(const Plugin& plugin) {
    const std::optional<glm::dvec3> s = colorOf(plugin, "sigma_s", ColorOf::Index);
    const std::optional<glm::dvec3> a = colorOf(plugin, "sigma_a", ColorOf::Index);
    const std::optional<glm::dvec3> t = colorOf(plugin, "sigma_t", ColorOf::Index);
    const std::optional<glm::dvec3> albedo = colorOf(plugin, "albedo", ColorOf::Index);
    const std::optional<std::string> name = plugin.text("material");
    Scattering found = kMedia[0].scattering;
    bool isKnown = !name;
    for (const NamedMedium& medium : kMedia)
        if (name && medium.name == inSmallLetters(*name)) {
            found = medium.scattering;
            isKnown = true;
        }
    if (!isKnown)
        plugin.replace(build::Shortfall::Model,
                       fmt::format("'material' is '{}', which is not known", *name), "skin1");
    if (s) found.scattered = *s;
    if (a) found.absorbed = *a;
    if (t || albedo) {
        const glm::dvec3 share = glm::clamp(albedo.value_or(found.albedo()), 0.0, 1.0);
        const glm::dvec3 extinction = t.value_or(found.extinction());
        found = {extinction * share, extinction * (1.0 - share)};
    }
    found.scattered = glm::max(found.scattered, 0.0);
    found.absorbed = glm::max(found.absorbed, 0.0);
    return found;
}

} // namespace stromboli::mitsuba
