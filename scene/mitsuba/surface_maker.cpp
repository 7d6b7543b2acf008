#include "scene/mitsuba/surface_maker.hpp"

#include <fmt/format.h>

namespace stromboli::mitsuba {

void SurfaceMaker::color(const char* name, const glm::dvec3& otherwise, glm::vec3& where,
                         TextureSlot slot) {
    const Shade shade = textures_.shade(plugin, name, ColorOf::Reflectance, otherwise);
    where = context_.builder.reflectedFraction(name, shade.color);
    if (!shade.attribute.empty() && slot == TextureSlot::BaseColor) { // as the colours of corners
        cornerColors_ = shade.attribute;
        cornerPaint_ = *shade.texture;
        return;
    }
    if (!shade.texture) return;
    TextureUse use = *shade.texture;
    use.slot = slot;
    material.textures.push_back(use);
}

void SurfaceMaker::plainColor(const char* name, const glm::dvec3& otherwise, glm::vec3& where) {
    const std::optional<glm::dvec3> stated = colorOf(plugin, name, ColorOf::Reflectance);
    if (!stated && plugin.child(name)) plugin.fail(name, "is a texture, expected a colour");
    where = context_.builder.reflectedFraction(name, stated.value_or(otherwise));
}

float SurfaceMaker::fraction(const char* name, double otherwise, TextureSlot slot, Layout layout,
                             double most) {
    const Plugin* object = plugin.child(name);
    if (!object) return float(plugin.number(name, 0, most).value_or(otherwise));
    const Shade shade =
        textures_.shade(plugin, name, ColorOf::Reflectance, glm::dvec3(otherwise), layout);
    if (shade.texture) {
        TextureUse use = *shade.texture;
        use.slot = slot;
        material.textures.push_back(use);
    }
    return float(shade.color.x);
}

void SurfaceMaker::facets() {
    const std::string name = plugin.text("distribution").value_or("beckmann");
    if (name != "beckmann" && name != "ggx")
        plugin.fail("distribution", fmt::format("is '{}', expected beckmann or ggx", name));
    material.facets.distribution =
        name == "ggx" ? FacetDistribution::Ggx : FacetDistribution::Beckmann;
    material.facets.masking = FacetMasking::Separable;
    for (const char* parameter : {"alpha", "alpha_u", "alpha_v"})
        if (plugin.child(parameter)) plugin.fail(parameter, "is a texture, expected a float");
    const double alpha = plugin.number("alpha", 0, 1e3).value_or(0.1);
    material.facets.alpha = {float(plugin.number("alpha_u", 0, 1e3).value_or(alpha)),
                             float(plugin.number("alpha_v", 0, 1e3).value_or(alpha))};
    plugin.skip("sample_visible");
}

Surface SurfaceMaker::done() {
    plugin.requireAllRead();
    const bool isBurleys = material.kind == MaterialKind::Burley;
    const bool hasBack = material.kind == MaterialKind::Dielectric ||
                         material.kind == MaterialKind::ThinDielectric ||
                         (isBurleys && (material.burley.transmits() || material.burley.isThin));
    // Walls of old scenes are turned either way, as renderers that read them show both sides.
    material.isBlackBehind = !hasBack && !plugin.isOld;
    return {std::move(material), cornerColors_, cornerPaint_, nullptr};
}

} // namespace stromboli::mitsuba
