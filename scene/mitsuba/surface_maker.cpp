#include "scene/mitsuba/surface_maker.hpp"

#include "scene/mitsuba/upgrade.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::mitsuba {

void SurfaceMaker::color(const char* name, const glm::dvec3& otherwise, glm::vec3& where,
                         TextureSlot slot) {
    put(name, textures_.shade(plugin, name, ColorOf::Reflectance, otherwise), where, slot);
}

void SurfaceMaker::put(const char* name, const Shade& shade, glm::vec3& where, TextureSlot slot) {
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
    const Shade shade = textures_.shade(plugin, name, ColorOf::Reflectance, otherwise);
    if (shade.texture) sayMean(name);
    where = context_.builder.reflectedFraction(name, textures_.meanOf(shade));
}

void SurfaceMaker::sayMean(const char* name) {
    plugin.replace(build::Shortfall::Model,
                   fmt::format("'{}' is a texture, expected one number or colour", name),
                   "its mean");
}

float SurfaceMaker::alpha(const char* name, double otherwise, std::optional<Layout> layout) {
    constexpr double kMost = 1e3;
    if (layout) return fraction(name, otherwise, TextureSlot::MetallicRoughness, *layout, kMost);
    if (!plugin.child(name)) return float(plugin.number(name, 0, kMost).value_or(otherwise));
    const Shade shade = textures_.shade(plugin, name, ColorOf::Reflectance, glm::dvec3(otherwise));
    if (shade.texture) sayMean(name);
    return float(std::clamp(textures_.meanOf(shade).x, 0.0, kMost));
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

void SurfaceMaker::facets(bool mayHaveTextures) {
    const std::string name = inSmallLetters(plugin.text("distribution").value_or("beckmann"));
    if (name != "beckmann" && name != "ggx")
        plugin.replace(build::Shortfall::Model,
                       fmt::format("'distribution' is '{}', expected beckmann or ggx", name),
                       "beckmann");
    material.facets.distribution =
        name == "ggx" ? FacetDistribution::Ggx : FacetDistribution::Beckmann;
    material.facets.masking = FacetMasking::Separable;
    // The slot has alpha along the tangent in green, and across it in blue.
    const bool hasAxes = plugin.child("alpha_u") || plugin.child("alpha_v");
    const auto layout = [&](Layout where) {
        return mayHaveTextures ? std::optional(where) : std::nullopt;
    };
    const float both = alpha("alpha", 0.1, hasAxes ? std::nullopt : layout(Layout::GreenAndBlue));
    material.facets.alpha = {alpha("alpha_u", both, layout(Layout::Green)),
                             alpha("alpha_v", both, layout(Layout::Blue))};
    plugin.skip("sample_visible");
}

Surface SurfaceMaker::done() {
    plugin.requireAllRead();
    const bool isBurleys = material.kind == MaterialKind::Burley;
    const bool hasBack = material.kind == MaterialKind::Dielectric ||
                         material.kind == MaterialKind::ThinDielectric ||
                         (isBurleys && (material.burley.transmits() || material.burley.isThin));
    material.isBlackBehind = !hasBack && !context_.document.isRainbows();
    return {std::move(material), cornerColors_, cornerPaint_, nullptr};
}

} // namespace stromboli::mitsuba
