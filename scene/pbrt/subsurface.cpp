#include "scene/pbrt/subsurface.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {
namespace {

/// The share that a deep medium sends back of diffuse light: H. C. van de Hulst's approximation
/// (Multiple Light Scattering, 1980).
double depthReflectance(double scattered, double absorbed, double g) {
    const double extinction = scattered + absorbed;
    if (!(extinction > 0)) return 0;
    const double albedo = std::clamp(scattered / extinction, 0.0, 1.0);
    const double s = std::sqrt((1 - albedo) / std::max(1 - albedo * g, 1e-9));
    return std::clamp((1 - s) * (1 - 0.139 * s) / (1 + 1.17 * s), 0.0, 1.0);
}

} // namespace

Surface subsurface(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Plastic);
    const Parameters& p = maker.parameters;
    Material& m = surface.material;
    m.isNonlinear = true;
    m.ior = float(indexOf(maker.context, p, 1.33));
    p.replace(build::Shortfall::Medium, "scatters light under the surface",
              "a diffuse base of the same colour is under it");
    maker.facets(surface, "", 0);
    const char* color =
        p.has("Kd") || maker.statement.kind == "kdsubsurface" ? "Kd" : "reflectance";
    if (p.has(color) || maker.statement.kind == "kdsubsurface") {
        maker.color(surface, maker.pattern(color, glm::dvec3(0.5)), m.albedo,
                    TextureSlot::BaseColor, color);
    } else {
        const glm::dvec3 s = maker.pattern("sigma_s", {2.55, 3.21, 3.77}, ColorOf::Number).mean();
        const glm::dvec3 a =
            maker.pattern("sigma_a", {0.0011, 0.0024, 0.014}, ColorOf::Number).mean();
        const double g = p.number("g", 0, -0.999, 0.999);
        for (const int c : {0, 1, 2})
            m.albedo[c] = float(depthReflectance(std::max(s[c], 0.0), std::max(a[c], 0.0), g));
    }
    if (maker.context.isV3()) m.reflectance = maker.plainColor("Kr", glm::dvec3(1));
    p.skip({"mfp", "scale", "g", "name", "sigma_a", "sigma_s", "Kr", "Kt", "reflectance"});
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
        // Absorption by melanin and the colour of hair that absorbs so much: Chiang et al., "A
        // Practical and Controllable Hair and Fur Model", 2016.
        const double dark = maker.number("eumelanin", p.has("pheomelanin") ? 0 : 1.3, 0, 1e3);
        const double red = maker.number("pheomelanin", 0, 0, 1e3);
        const glm::dvec3 absorbed =
            maker
                .pattern("sigma_a",
                         dark * glm::dvec3(0.419, 0.697, 1.37) + red * glm::dvec3(0.187, 0.4, 1.05),
                         ColorOf::Number)
                .mean();
        const double width = 5.969 - 0.215 * b + 2.532 * b * b - 10.73 * std::pow(b, 3) +
                             5.574 * std::pow(b, 4) + 0.245 * std::pow(b, 5);
        color = glm::exp(-glm::sqrt(glm::max(absorbed, 0.0)) * width);
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
