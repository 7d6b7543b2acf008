// The materials of pbrt-v3.

#include "scene/pbrt/subsurface.hpp"
#include "scene/pbrt/surface_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::pbrt {
namespace {

double largestOf(const Pattern& pattern) {
    // The largest value of a picture: 1 at most where its factor is.
    const glm::dvec3 c = pattern.isConstant || pattern.texture ? pattern.color : glm::dvec3(1);
    return std::clamp(std::max({c.x, c.y, c.z}), 0.0, 1.0);
}

SurfaceMaker::Lobe diffuseLobe(const SurfaceMaker& maker, const Pattern& color) {
    Surface surface = maker.empty(MaterialKind::Diffuse);
    maker.color(surface, color, surface.material.albedo, TextureSlot::BaseColor, "Kd");
    return {std::move(surface), largestOf(color), false};
}

/// What an interface reflects, and nothing below it.
SurfaceMaker::Lobe glossyLobe(const SurfaceMaker& maker, const Pattern& color, double roughness,
                              double ior, bool isSmooth = false) {
    Surface surface = maker.empty(MaterialKind::Plastic);
    Material& m = surface.material;
    m.albedo = glm::vec3(0);
    m.ior = float(ior);
    if (!isSmooth) maker.facets(surface, "", roughness);
    maker.color(surface, color, m.reflectance, TextureSlot::SpecularColor, "Ks");
    return {std::move(surface), largestOf(color), true};
}

Surface matte(const SurfaceMaker& maker) {
    if (maker.number("sigma", 0, 0, 1e3) > 0)
        maker.parameters.replace(build::Shortfall::Model,
                                 "'sigma' makes the surface reflect as Oren and Nayar say",
                                 "Lambert's law");
    return diffuseLobe(maker, maker.pattern("Kd", glm::dvec3(0.5))).surface;
}

Surface plastic(const SurfaceMaker& maker) {
    const Pattern kd = maker.pattern("Kd", glm::dvec3(0.25)),
                  ks = maker.pattern("Ks", glm::dvec3(0.25));
    return maker.sum({diffuseLobe(maker, kd), glossyLobe(maker, ks, 0.1, 1.5)});
}

Surface metal(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Conductor);
    const build::MetalIndex index = metalOf(maker.context, maker.parameters, "eta", "k");
    surface.material.eta = index.eta;
    surface.material.k = index.k;
    maker.facets(surface, "", 0.01);
    return surface;
}

Surface mirror(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Conductor); // one that reflects all light
    Material& m = surface.material;
    m.eta = glm::vec3(0);
    m.k = glm::vec3(1);
    maker.color(surface, maker.pattern("Kr", glm::dvec3(0.9)), m.reflectance,
                TextureSlot::BaseColor, "Kr");
    return surface;
}

/// A textured colour needs facets: smooth glass has one for all of the surface.
Surface glass(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Dielectric);
    Material& m = surface.material;
    m.ior = float(indexOf(maker.context, maker.parameters, 1.5));
    maker.facets(surface, "", 0);
    // pbrt-v3 remaps a roughness of 0 too, but for this material.
    const auto isZero = [&](const char* name) { return maker.number(name, 0, 0, 1e3) == 0; };
    if (isZero("uroughness") && isZero("vroughness")) m.facets.alpha = glm::vec2(0);
    if (m.isSmooth()) {
        m.reflectance = maker.plainColor("Kr", glm::dvec3(1));
        m.transmittance = maker.plainColor("Kt", glm::dvec3(1));
    } else {
        maker.color(surface, maker.pattern("Kr", glm::dvec3(1)), m.reflectance,
                    TextureSlot::SpecularColor, "Kr");
        maker.color(surface, maker.pattern("Kt", glm::dvec3(1)), m.transmittance,
                    TextureSlot::BaseColor, "Kt");
    }
    return surface;
}

Surface uber(const SurfaceMaker& maker) {
    const double ior = indexOf(maker.context, maker.parameters, 1.5);
    const Pattern kd = maker.pattern("Kd", glm::dvec3(0.25)),
                  ks = maker.pattern("Ks", glm::dvec3(0.25));
    std::vector<SurfaceMaker::Lobe> lobes = {diffuseLobe(maker, kd),
                                             glossyLobe(maker, ks, 0.1, ior)};
    const glm::vec3 kr = maker.plainColor("Kr", glm::dvec3(0)),
                    kt = maker.plainColor("Kt", glm::dvec3(0));
    const auto most = [](const glm::vec3& c) { return double(std::max({c.x, c.y, c.z})); };
    if (most(kt) > 0) {
        Surface clear = maker.empty(MaterialKind::Dielectric);
        clear.material.ior = float(ior);
        clear.material.reflectance = kr;
        clear.material.transmittance = kt;
        lobes.push_back({std::move(clear), std::max(most(kr), most(kt)), false});
    } else if (most(kr) > 0) {
        lobes.push_back(glossyLobe(maker, Pattern::constant(kr), 0, ior, true));
    }
    Surface surface = maker.sum(std::move(lobes));
    const double opacity = luminance(glm::dvec3(maker.plainColor("opacity", glm::dvec3(1))));
    if (opacity < 1) {
        surface.material.alphaMode = AlphaMode::Blend;
        surface.material.opacity = float(opacity);
    }
    return surface;
}

/// A diffuse base under a gloss that reflects Ks where it is looked at straight.
Surface substrate(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Principled);
    PrincipledParameters& p = surface.material.principled;
    const glm::dvec3 ks(maker.plainColor("Ks", glm::dvec3(0.5)));
    const double most = std::clamp(largestOf(Pattern::constant(ks)), 0.0, 0.98);
    maker.say("a diffuse base under facets that reflect as much");
    p.metallic = 0;
    p.ior = float((1 + std::sqrt(most)) / (1 - std::sqrt(most)));
    p.specularColor = most > 0 ? glm::vec3(glm::min(ks / most, 1.0)) : glm::vec3(0);
    maker.facets(surface, "", 0.1, false);
    const glm::vec2 alpha = surface.material.facets.alpha;
    p.roughness = std::sqrt(std::clamp((alpha.x + alpha.y) / 2, 0.0f, 1.0f));
    maker.color(surface, maker.pattern("Kd", glm::dvec3(0.5)), p.baseColor, TextureSlot::BaseColor,
                "Kd");
    return surface;
}

Surface translucent(const SurfaceMaker& maker) {
    const glm::dvec3 r(maker.plainColor("reflect", glm::dvec3(0.5))),
        t(maker.plainColor("transmit", glm::dvec3(0.5)));
    const Pattern kd = maker.pattern("Kd", glm::dvec3(0.25));
    const auto times = [](const Pattern& pattern, const glm::dvec3& factor) {
        Pattern result;
        combine(
            pattern, Pattern::constant(factor), Pattern(),
            [](const auto& a, const auto& b, const auto&) { return a * b; }, result);
        if (pattern.texture) {
            result.texture = pattern.texture;
            result.color = pattern.color * factor;
        }
        return result;
    };
    std::vector<SurfaceMaker::Lobe> lobes = {diffuseLobe(maker, times(kd, r))};
    const Pattern through = times(kd, t);
    lobes.push_back({maker.diffuseTransmitter(through), largestOf(through), false});
    const glm::dvec3 ks(maker.plainColor("Ks", glm::dvec3(0.25)));
    Surface gloss = maker.empty(MaterialKind::Dielectric);
    gloss.material.ior = 1.5f;
    maker.facets(gloss, "", 0.1);
    gloss.material.reflectance = ks * r;
    gloss.material.transmittance = ks * t;
    lobes.push_back({std::move(gloss), largestOf(Pattern::constant(ks * glm::max(r, t))), false});
    return maker.sum(std::move(lobes));
}

Surface disney(const SurfaceMaker& maker) {
    using enum TextureSlot;
    using build::Layout;
    Surface surface = maker.empty(MaterialKind::Burley);
    BurleyParameters& p = surface.material.burley;
    maker.color(surface, maker.pattern("color", glm::dvec3(0.5)), p.baseColor, BaseColor, "color");
    const auto read = [&](const char* name, double otherwise, TextureSlot slot, Layout layout) {
        return maker.fraction(surface, name, otherwise, slot, layout);
    };
    p.metallic = read("metallic", 0, MetallicRoughness, Layout::Blue);
    p.roughness = read("roughness", 0.5, MetallicRoughness, Layout::Green);
    p.anisotropy = read("anisotropic", 0, Anisotropy, Layout::Blue);
    p.specularTint = read("speculartint", 0, Specular, Layout::Alpha);
    p.sheen = read("sheen", 0, SheenColor, Layout::Red);
    p.sheenTint = read("sheentint", 0.5, SheenRoughness, Layout::Alpha);
    p.clearcoat = read("clearcoat", 0, Clearcoat, Layout::Red);
    p.clearcoatGloss = read("clearcoatgloss", 1, ClearcoatRoughness, Layout::Green);
    p.transmission = read("spectrans", 0, Transmission, Layout::Red);
    p.ior = float(maker.number("eta", 1.5, 1, 100));
    p.isThin = maker.parameters.flag("thin", false);
    if (p.isThin) {
        p.flatness = float(maker.number("flatness", 0, 0, 1));
        p.diffuseTransmission = 0.5f * float(maker.number("difftrans", 1, 0, 2));
        p.metallic = p.clearcoat = 0;
    }
    maker.parameters.skip({"flatness", "difftrans"});
    if (maker.parameters.has("scatterdistance")) {
        maker.parameters.skip({"scatterdistance"});
        maker.parameters.replace(build::Shortfall::Medium,
                                 "'scatterdistance' scatters light under the surface");
    }
    return surface;
}

Surface fourier(const SurfaceMaker& maker) {
    maker.parameters.skip({"bsdffile"});
    return maker.replaced("mid grey");
}

} // namespace

bool makeV3(const SurfaceMaker& maker, Surface& surface) {
    struct Kind {
        std::string_view name;
        Surface (*make)(const SurfaceMaker&);
    };
    static constexpr Kind kKinds[] = {{"matte", matte},
                                      {"plastic", plastic},
                                      {"metal", metal},
                                      {"mirror", mirror},
                                      {"glass", glass},
                                      {"uber", uber},
                                      {"substrate", substrate},
                                      {"translucent", translucent},
                                      {"disney", disney},
                                      {"fourier", fourier},
                                      {"subsurface", subsurface},
                                      {"kdsubsurface", subsurface},
                                      {"hair", hair},
                                      {"shinymetal", mirror}};
    const auto* kind = std::ranges::find(kKinds, maker.statement.kind, &Kind::name);
    if (kind == std::end(kKinds)) return false;
    surface = kind->make(maker);
    return true;
}

} // namespace stromboli::pbrt
