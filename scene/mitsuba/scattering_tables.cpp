#include "scene/mitsuba/scattering_tables.hpp"

#include "scene/mitsuba/colors.hpp"

#include <fmt/format.h>

namespace stromboli::mitsuba {

Scattering scatteringOf(const Plugin& plugin) {
    const std::optional<glm::dvec3> s = colorOf(plugin, "sigma_s", ColorOf::Index);
    const std::optional<glm::dvec3> a = colorOf(plugin, "sigma_a", ColorOf::Index);
    const std::optional<glm::dvec3> t = colorOf(plugin, "sigma_t", ColorOf::Index);
    const std::optional<glm::dvec3> albedo = colorOf(plugin, "albedo", ColorOf::Index);
    const std::optional<std::string> name = plugin.text("material");
    const std::optional<Scattering> known = build::measuredMedium(name.value_or("skin1"));
    if (!known)
        plugin.replace(build::Shortfall::Model,
                       fmt::format("'material' is '{}', which is not known", *name), "skin1");
    Scattering found = known.value_or(*build::measuredMedium("skin1"));
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
