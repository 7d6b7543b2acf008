#include "scene/pbrt/subsurface.hpp"

#include "scene/build/hair_color.hpp"
#include "scene/pbrt/media.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {
namespace {

/// A diffuse base under the interface: for what varies over a surface.
void takeBase(const SurfaceMaker& maker, Surface& surface, const Pattern& pattern,
              const char* name) {
    Material& m = surface.material;
    m.kind = MaterialKind::Plastic;
    m.isNonlinear = true;
    maker.parameters.replace(build::Shortfall::Medium,
                             "scatters light under the surface by a texture",
                             "a diffuse base of the same colours is under it");
    maker.color(surface, pattern, m.albedo, TextureSlot::BaseColor, name);
}

/// A medium is alike everywhere: of a texture the mean is taken, which is said.
glm::dvec3 plainNumbers(const SurfaceMaker& maker, const char* name, const glm::dvec3& otherwise) {
    const Pattern pattern = maker.pattern(name, otherwise, ColorOf::Number);
    if (!pattern.isConstant)
        maker.parameters.replace(build::Shortfall::Medium,
                                 "'" + std::string(name) + "' is a texture, expected one colour",
                                 "its mean");
    return glm::max(pattern.mean(), 0.0);
}

} // namespace

Surface subsurface(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Dielectric);
    const Parameters& p = maker.parameters;
    Material& m = surface.material;
    m.ior = float(indexOf(maker.context, p, 1.33));
    maker.facets(surface, "", 0);
    if (maker.context.isV3()) {
        m.reflectance = maker.plainColor("Kr", glm::dvec3(1));
        m.transmittance = maker.plainColor("Kt", glm::dvec3(1));
    }
    const bool isByColor = maker.statement.kind == "kdsubsurface";
    const char* color = isByColor ? "Kd" : "reflectance";
    const double scale = p.number("scale", 1, 0, 1e30);
    const double g = p.number("g", 0, -double(kMostAsymmetry), double(kMostAsymmetry));
    Medium medium;
    medium.isUnderSurface = true;
    build::Scattering s;
    const bool isByPath = !p.has("name") && (isByColor || p.has(color));
    if (const std::optional<std::string> name = p.text("name")) {
        s = measured(p, "name", *name); // reduced, as if g were 0
    } else if (isByPath) {
        const Pattern pattern = maker.pattern(color, glm::dvec3(0.5));
        const glm::dvec3 path = plainNumbers(maker, "mfp", glm::dvec3(1));
        if (!pattern.isConstant) {
            takeBase(maker, surface, pattern, color);
            return surface;
        }
        s = build::scatteringUnder(pattern.color, glm::max(scale * path, 1e-9), g, double(m.ior));
        medium.asymmetry = float(g);
    } else {
        s.scattered = plainNumbers(maker, "sigma_s", wholeMilk().scattered);
        s.absorbed = plainNumbers(maker, "sigma_a", wholeMilk().absorbed);
        medium.asymmetry = float(g);
    }
    if (!isByPath) s.scattered *= scale, s.absorbed *= scale;
    medium.scattering = s.scattered;
    medium.absorption = s.absorbed;
    surface.under = std::make_shared<Medium>(medium);
    p.skip({"mfp", "scale", "g", "name", "sigma_a", "sigma_s", "Kr", "Kt", "reflectance", "Kd"});
    return surface;
}

Surface hair(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Principled);
    const Parameters& p = maker.parameters;
    const double beta = maker.number("beta_m", 0.3, 0, 1);
    const double b = maker.number("beta_n", 0.3, 0, 1);
    std::optional<glm::dvec3> color;
    for (const char* name : {"reflectance", "color"})
        if (p.has(name)) color = maker.pattern(name, glm::dvec3(0.5)).mean();
    if (!color) {
        const double dark = maker.number("eumelanin", p.has("pheomelanin") ? 0 : 1.3, 0, 1e3);
        const double red = maker.number("pheomelanin", 0, 0, 1e3);
        const glm::dvec3 absorbed =
            maker.pattern("sigma_a", build::absorptionOfHair(dark, red), ColorOf::Number).mean();
        color = build::colorOfHair(absorbed, b);
    }
    maker.say("a rough surface of its colour");
    PrincipledParameters& principled = surface.material.principled;
    principled.baseColor = glm::vec3(glm::clamp(*color, 0.0, 1.0));
    principled.metallic = 0;
    principled.roughness = float(std::sqrt(beta));
    principled.ior = float(maker.number("eta", 1.55, 1, 10));
    p.skip({"alpha", "sigma_a", "eumelanin", "pheomelanin", "beta_m", "beta_n", "color",
            "reflectance"});
    return surface;
}

} // namespace stromboli::pbrt
