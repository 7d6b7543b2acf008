#include "scene/mitsuba/replaced_bsdfs.hpp"

#include "scene/build/fresnel.hpp"
#include "scene/build/hair_color.hpp"
#include "scene/mitsuba/media_tables.hpp"
#include "scene/mitsuba/nested_bsdfs.hpp"
#include "scene/mitsuba/scattering_tables.hpp"
#include "scene/mitsuba/surface_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

double largest(const glm::dvec3& color) {
    return std::clamp(std::max({color.x, color.y, color.z}), 0.0, 1.0);
}

void say(const Plugin& plugin, const std::string& instead) {
    plugin.replace(build::Shortfall::Model,
                   fmt::format("'{}' is no bsdf that is read", plugin.type),
                   fmt::format("of bsdf '{}' {}", plugin.type, instead));
}

/// A diffuse and a glossy part that are added. Here light finds one of two materials, each in the
/// share of the sum that it may reflect at most, and made so much brighter that the sum is the
/// same.
Surface sumOfLobes(Context& context, Textures& textures, const Plugin& plugin,
                   const Facets& facets) {
    Shade diffuse =
        textures.shade(plugin, "diffuse_reflectance", ColorOf::Reflectance, glm::dvec3(0.5));
    Shade glossy =
        textures.shade(plugin, "specular_reflectance", ColorOf::Reflectance, glm::dvec3(0.2));
    diffuse.color *= plugin.number("diffuse_amount", 0).value_or(1);
    glossy.color *= plugin.number("specular_amount", 0).value_or(1);
    const double mostDiffuse = largest(textures.mostOf(diffuse));
    const double mostGlossy = largest(textures.mostOf(glossy));
    const double sum = mostDiffuse + mostGlossy;
    // More than all light is not reflected, in Mitsuba either.
    const double together = std::min(sum, 1.0);
    if (mostDiffuse > 0) diffuse.color *= together / mostDiffuse;
    if (mostGlossy > 0) glossy.color *= together / mostGlossy;
    SurfaceMaker base(plugin, textures, context), gloss(plugin, textures, context);
    base.material.kind = MaterialKind::Diffuse;
    base.put("diffuse_reflectance", diffuse, base.material.albedo, TextureSlot::BaseColor);
    gloss.material.kind = MaterialKind::Conductor; // one that reflects all light
    gloss.material.eta = glm::vec3(0);
    gloss.material.k = glm::vec3(1);
    gloss.material.facets = facets;
    gloss.put("specular_reflectance", glossy, gloss.material.reflectance, TextureSlot::BaseColor);
    if (!(mostGlossy > 0)) return base.done();
    if (!(mostDiffuse > 0)) return gloss.done();
    return mixed(plugin, base.done(), gloss.done(), mostGlossy / sum, {});
}

/// Phong's cosine about the mirror direction falls off as Beckmann's facets do whose alpha is this:
/// the normal between turns by half as much as the direction.
Surface phong(Context& context, Textures& textures, const Plugin& plugin) {
    say(plugin, "Beckmann's facets as wide as its lobe, over a diffuse base");
    const double exponent =
        textures.meanOf(textures.shade(plugin, "exponent", ColorOf::Reflectance, glm::dvec3(30))).x;
    Facets facets;
    facets.distribution = FacetDistribution::Beckmann;
    facets.masking = FacetMasking::Separable;
    facets.alpha = glm::vec2(float(1 / std::sqrt(2 * std::max(exponent, 0.0) + 1)));
    return sumOfLobes(context, textures, plugin, facets);
}

Surface ward(Context& context, Textures& textures, const Plugin& plugin) {
    say(plugin, "Beckmann's facets of the same alpha, over a diffuse base");
    plugin.skip("variant");
    SurfaceMaker maker(plugin, textures, context);
    maker.facets(false);
    return sumOfLobes(context, textures, plugin, maker.material.facets);
}

Surface roughDiffuse(Context& context, Textures& textures, const Plugin& plugin) {
    say(plugin, "diffuse of the same reflectance");
    SurfaceMaker maker(plugin, textures, context);
    maker.material.kind = MaterialKind::Diffuse;
    maker.color("reflectance", glm::dvec3(0.5), maker.material.albedo, TextureSlot::BaseColor);
    for (const char* unused : {"alpha", "use_fast_approx"})
        plugin.skip(unused);
    return maker.done();
}

/// Exactly: of a thin sheet all diffuse light goes through.
Surface diffuseTransmitter(Context& context, Textures& textures, const Plugin& plugin) {
    SurfaceMaker maker(plugin, textures, context);
    Material& m = maker.material;
    m.kind = MaterialKind::Burley;
    m.burley.isThin = true;
    m.burley.ior = 1;
    m.burley.diffuseTransmission = 1;
    maker.color("transmittance", glm::dvec3(0.5), m.burley.baseColor, TextureSlot::BaseColor);
    return maker.done();
}

/// What a coating makes of one material; false where nothing comes near.
bool coat(Material& m, const Material& coating, const glm::dvec3& through) {
    if (m.kind == MaterialKind::Diffuse) {
        // A diffuse base under an interface, but what the interface sends back is lost.
        m.kind = MaterialKind::Plastic;
        m.ior = coating.ior;
        m.facets = coating.facets;
        m.reflectance = coating.reflectance;
        m.internalViews = 64;
        m.albedo *= glm::vec3(through * (1 - build::internalReflection(m.ior)));
        return true;
    }
    if (m.kind == MaterialKind::Conductor && !m.isSmooth() &&
        std::ranges::none_of(m.textures, [](const TextureUse& use) {
            return use.slot == TextureSlot::MetallicRoughness;
        })) {
        const glm::dvec3 eta(m.eta), k(m.k), one(1.0);
        const glm::dvec3 facing =
            ((eta - one) * (eta - one) + k * k) / ((eta + one) * (eta + one) + k * k);
        m.kind = MaterialKind::Principled;
        m.principled = {};
        m.principled.baseColor = glm::vec3(facing * through) * m.reflectance;
        m.principled.roughness =
            std::sqrt(std::min(1.0f, (m.facets.alpha.x + m.facets.alpha.y) / 2));
        m.principled.clearcoat = 1;
        m.principled.clearcoatRoughness = std::sqrt(std::min(1.0f, coating.facets.alpha.x));
        return true;
    }
    return false;
}

Surface coating(Context& context, Textures& textures, const Plugin& plugin) {
    SurfaceMaker maker(plugin, textures, context);
    Material& own = maker.material;
    own.ior = float(refractiveIndex(plugin, "int_ior", "bk7") /
                    refractiveIndex(plugin, "ext_ior", "air"));
    own.facets.alpha = glm::vec2(0);
    if (plugin.type == "roughcoating") maker.facets(false);
    maker.plainColor("specular_reflectance", glm::dvec3(1), own.reflectance);
    const double thickness = plugin.number("thickness", 0).value_or(1);
    const glm::dvec3 absorbed =
        textures.meanOf(textures.shade(plugin, "sigma_a", ColorOf::Index, glm::dvec3(0)));
    Surface surface = insideOf(context, textures, plugin);
    plugin.requireAllRead();
    bool isCoated = true;
    for (Surface* each = &surface; each; each = each->other.get())
        isCoated = coat(each->material, own, glm::exp(-2.0 * thickness * absorbed)) && isCoated;
    say(plugin, isCoated ? "plastic, or metal with a clear coat" : "what is under it");
    return surface;
}

/// A layer that scatters light once: as much as comes back from a deep one, diffusely; what gets
/// through a thin one goes on.
Surface layer(Context& context, Textures& textures, const Plugin& plugin) {
    say(plugin, "diffuse of the same albedo, and opacity");
    plugin.childrenOf("phase");
    const Scattering s = scatteringOf(plugin);
    const double thickness = plugin.number("thickness", 0).value_or(1);
    SurfaceMaker maker(plugin, textures, context);
    Material& m = maker.material;
    m.kind = MaterialKind::Diffuse;
    // The mean over all directions of single scattering in half of space: 2 (1 - ln 2) / 3.
    const double back = 2 * (1 - std::log(2.0)) / 3;
    m.albedo = context.builder.reflectedFraction("albedo", glm::vec3(s.albedo() * back));
    const glm::dvec3 depth = thickness * s.extinction();
    m.alphaMode = AlphaMode::Blend;
    m.opacity = float(1 - std::exp(-(depth.x + depth.y + depth.z) / 3));
    return maker.done();
}

Surface hair(Context& context, Textures& textures, const Plugin& plugin) {
    say(plugin, "a rough surface of its colour");
    const auto fraction = [&](const char* name) { return plugin.number(name, 0, 1).value_or(0.3); };
    const double along = fraction("longitudinal_roughness"),
                 about = fraction("azimuthal_roughness");
    const double red = plugin.number("pheomelanin", 0).value_or(0);
    const double dark = plugin.number("eumelanin", 0).value_or(1.3);
    const glm::dvec3 absorbed = textures.meanOf(
        textures.shade(plugin, "sigma_a", ColorOf::Index, build::absorptionOfHair(dark, red)));
    plugin.skip("scale_tilt");
    SurfaceMaker maker(plugin, textures, context);
    Material& m = maker.material;
    m.kind = MaterialKind::Principled;
    m.principled.baseColor = glm::vec3(build::colorOfHair(absorbed, about));
    m.principled.metallic = 0;
    m.principled.roughness = float(std::sqrt(along));
    m.principled.ior = float(refractiveIndex(plugin, "int_ior", "amber") /
                             refractiveIndex(plugin, "ext_ior", "air"));
    return maker.done();
}

/// What turns or chooses a polarisation, which light does not have here: it lets through as much of
/// light without any.
Surface polarizationFilter(Context& context, Textures& textures, const Plugin& plugin) {
    say(plugin, "a surface that lets as much light through");
    SurfaceMaker maker(plugin, textures, context);
    glm::vec3 through(1.0f);
    maker.plainColor("transmittance", glm::dvec3(1), through);
    for (const char* unused : {"theta", "delta", "left_handed", "polarizing"})
        plugin.skip(unused);
    const float kept = plugin.type == "retarder" ? 1.0f : 0.5f;
    Material& m = maker.material;
    m.kind = MaterialKind::Diffuse;
    m.albedo = glm::vec3(0);
    m.alphaMode = AlphaMode::Blend;
    m.opacity = 1 - kept * (through.x + through.y + through.z) / 3;
    return maker.done();
}

/// The one inside, or diffuse of a texture or of a colour that it states.
Surface unknown(Context& context, Textures& textures, const Plugin& plugin) {
    if (!plugin.childrenOf("bsdf").empty()) {
        say(plugin, "the bsdf inside of it");
        return readBsdf(context, textures, *plugin.childrenOf("bsdf").front());
    }
    SurfaceMaker maker(plugin, textures, context);
    Material& m = maker.material;
    m.kind = MaterialKind::Diffuse;
    std::optional<Shade> shade;
    if (const std::optional<glm::dvec3> color = firstColorOf(plugin, ColorOf::Reflectance))
        shade = Shade{*color, {}, {}};
    else if (const auto inside = plugin.childrenOf("texture"); !inside.empty())
        shade = textures.texture(*inside.front(), ColorOf::Reflectance, Layout::Color);
    if (!shade)
        plugin.fail(fmt::format("'{}' is no bsdf that is read, and states no colour", plugin.type));
    say(plugin, "diffuse of its first colour");
    maker.put("its first colour", *shade, m.albedo, TextureSlot::BaseColor);
    return maker.done();
}

} // namespace

Surface replacedBsdf(Context& context, Textures& textures, const Plugin& bsdf) {
    const std::string& type = bsdf.type;
    if (type == "phong") return phong(context, textures, bsdf);
    if (type == "ward") return ward(context, textures, bsdf);
    if (type == "roughdiffuse") return roughDiffuse(context, textures, bsdf);
    if (type == "difftrans") return diffuseTransmitter(context, textures, bsdf);
    if (type == "coating" || type == "roughcoating") return coating(context, textures, bsdf);
    if (type == "hk") return layer(context, textures, bsdf);
    if (type == "hair") return hair(context, textures, bsdf);
    if (type == "polarizer" || type == "circular" || type == "retarder")
        return polarizationFilter(context, textures, bsdf);
    return unknown(context, textures, bsdf);
}

} // namespace stromboli::mitsuba
