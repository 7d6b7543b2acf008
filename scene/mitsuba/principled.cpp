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
        plugin.replaceParameter("specular", build::Shortfall::Parameter,
                                "is stated beside eta, expected one of both");
    if (const std::optional<double> eta = plugin.number("eta", 1, 100)) return *eta;
    return indexOfSpecular(plugin.number("specular", 0, 1).value_or(0.5));
}

/// What both plugins have. Numbers are in the slots where the renderers multiply them.
void readCommon(SurfaceMaker& maker, BurleyParameters& p) {
    maker.material.kind = MaterialKind::Burley;
    maker.color("base_color", glm::dvec3(0.5), p.baseColor, TextureSlot::BaseColor);
    p.roughness = maker.fraction("roughness", 0.5, TextureSlot::MetallicRoughness, Layout::Green);
    p.anisotropy = maker.fraction("anisotropic", 0, TextureSlot::Anisotropy, Layout::Blue);
    p.transmission = maker.fraction("spec_trans", 0, TextureSlot::Transmission, Layout::Red);
    p.specularTint = maker.fraction("spec_tint", 0, TextureSlot::Specular, Layout::Alpha);
    p.sheen = maker.fraction("sheen", 0, TextureSlot::SheenColor, Layout::Red);
    p.sheenTint = maker.fraction("sheen_tint", 0, TextureSlot::SheenRoughness, Layout::Alpha);
    p.flatness = maker.fraction("flatness", 0, TextureSlot::SpecularColor, Layout::Red);
}

void skipRates(const Plugin& plugin, std::initializer_list<const char*> names) {
    for (const char* name : names)
        plugin.skip(name);
}

} // namespace

Surface principled(SurfaceMaker& maker) {
    BurleyParameters& p = maker.material.burley;
    readCommon(maker, p);
    p.metallic = maker.fraction("metallic", 0, TextureSlot::MetallicRoughness, Layout::Blue);
    p.ior = float(indexOf(maker.plugin));
    p.clearcoat = maker.fraction("clearcoat", 0, TextureSlot::Clearcoat, Layout::Red);
    p.clearcoatGloss =
        maker.fraction("clearcoat_gloss", 0, TextureSlot::ClearcoatRoughness, Layout::Green);
    skipRates(maker.plugin, {"main_specular_sampling_rate", "clearcoat_sampling_rate",
                             "diffuse_reflectance_sampling_rate"});
    return maker.done();
}

Surface principledThin(SurfaceMaker& maker) {
    BurleyParameters& p = maker.material.burley;
    readCommon(maker, p);
    p.isThin = true;
    p.ior = float(maker.plugin.number("eta", 1, 100).value_or(1.5));
    // From 0 to 2: at 1 as much is transmitted as reflected.
    p.diffuseTransmission =
        0.5f * maker.fraction("diff_trans", 0, TextureSlot::SpecularColor, Layout::Green, 2);
    skipRates(maker.plugin,
              {"spec_reflect_sampling_rate", "spec_trans_sampling_rate", "diff_trans_sampling_rate",
               "diffuse_reflectance_sampling_rate", "diffuse_transmittance_sampling_rate",
               "specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate"});
    return maker.done();
}

} // namespace stromboli::mitsuba
