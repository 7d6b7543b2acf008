#include "scene/mitsuba/principled.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::mitsuba {
namespace {

/// Burley 2012: `specular` is reflectance at normal incidence in units of 0.08.
double indexOfSpecular(double specular) {
    return 2 / (1 - std::sqrt(0.08 * specular)) - 1;
}

double indexOf(const Plugin& plugin) {
    if (plugin.has("eta") && plugin.has("specular"))
        plugin.fail("eta", "is stated beside specular, expected one of both");
    if (plugin.has("eta")) return *plugin.number("eta", 1, 100);
    return indexOfSpecular(plugin.number("specular", 0, 1).value_or(0.5));
}

} // namespace

Surface principled(SurfaceMaker& maker) {
    const Plugin& plugin = maker.plugin;
    maker.material.kind = MaterialKind::Principled;
    PrincipledParameters& p = maker.material.principled;
    maker.color("base_color", glm::dvec3(0.5), p.baseColor, TextureSlot::BaseColor);
    p.roughness = maker.fraction("roughness", 0.5, TextureSlot::MetallicRoughness, Layout::Green);
    p.metallic = maker.fraction("metallic", 0, TextureSlot::MetallicRoughness, Layout::Blue);
    p.transmission = maker.fraction("spec_trans", 0, TextureSlot::Transmission, Layout::Red);
    p.isThin = false;
    p.ior = float(indexOf(plugin));
    // Its layer has a quarter of the weight, and alpha from 0.1 to 0.001.
    p.clearcoat = 0.25f * maker.fraction("clearcoat", 0, TextureSlot::Clearcoat, Layout::Red);
    const double gloss = plugin.number("clearcoat_gloss", 0, 1).value_or(0);
    p.clearcoatRoughness = float(std::sqrt(std::lerp(0.1, 0.001, gloss)));

    for (const char* name : {"anisotropic", "sheen", "sheen_tint", "spec_tint", "flatness"}) {
        const bool isObject = plugin.child(name) != nullptr;
        if (isObject || plugin.number(name).value_or(0) != 0)
            maker.report().warn(fmt::format("principled: '{}' has no counterpart here and is left "
                                            "out",
                                            name));
    }
    for (const char* name : {"main_specular_sampling_rate", "clearcoat_sampling_rate",
                             "diffuse_reflectance_sampling_rate"})
        plugin.skip(name);
    return maker.done();
}

} // namespace stromboli::mitsuba
