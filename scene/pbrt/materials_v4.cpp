// The materials of pbrt-v4.

#include "scene/build/fresnel.hpp"
#include "scene/pbrt/subsurface.hpp"
#include "scene/pbrt/surface_maker.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {
namespace {

Surface diffuse(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Diffuse);
    maker.color(surface, maker.pattern("reflectance", glm::dvec3(0.5)), surface.material.albedo,
                TextureSlot::BaseColor, "reflectance");
    return surface;
}

Surface diffuseTransmission(const SurfaceMaker& maker) {
    const double scale = maker.number("scale", 1, 0, 1e6);
    const auto scaled = [&](const char* name) {
        Pattern result;
        const Pattern stated = maker.pattern(name, glm::dvec3(0.25));
        combine(
            stated, Pattern::constant(glm::dvec3(scale)), Pattern(),
            [](const auto& a, const auto& b, const auto&) { return a * b; }, result);
        if (stated.texture) {
            result.texture = stated.texture;
            result.color = stated.color * scale;
        }
        return result;
    };
    const auto most = [](const Pattern& p) {
        const glm::dvec3 c = p.isConstant || p.texture ? p.color : glm::dvec3(1);
        return std::clamp(std::max({c.x, c.y, c.z}), 0.0, 1.0);
    };
    const Pattern r = scaled("reflectance"), t = scaled("transmittance");
    Surface back = maker.empty(MaterialKind::Diffuse);
    maker.color(back, r, back.material.albedo, TextureSlot::BaseColor, "reflectance");
    return maker.sum(
        {{std::move(back), most(r), false}, {maker.diffuseTransmitter(t), most(t), false}});
}

/// A pbrt layer without scattering inside attenuates light by its thickness along the way. Here
/// there is none: the base is so much darker.
class Layer {
  public:
    /// bounces: of light between base and interface at most.
    Layer(double ior, double thickness, double bounces)
        : back_(build::internalReflection(ior)), bounces_(bounces) {
        // Means of exp(-thickness / cosine) over cosine-weighted directions that the interface lets
        // through, and over those that it sends back.
        constexpr int kSteps = 200;
        const double critical = std::sqrt(std::max(1 - 1 / (ior * ior), 0.0));
        int out = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double squared =
                (i + 0.5) / kSteps; // the cosine's, so that all parts weigh alike
            const double cosine = std::sqrt(squared), passed = std::exp(-thickness / cosine);
            const bool isOut = cosine > critical;
            out += isOut ? 1 : 0;
            (isOut ? through_ : inside_) += isOut ? passed : passed * passed;
        }
        through_ /= std::max(out, 1);
        inside_ /= std::max(kSteps - out, 1);
    }

    /// The albedo of a base under a clear interface that looks like this one.
    double darkened(double reflected) const {
        const double ratio = std::min(reflected * back_ * inside_, 0.999);
        const double sum = (1 - std::pow(ratio, bounces_)) / (1 - ratio);
        const double all = reflected * through_ * through_ * sum;
        return all / (1 + all * back_);
    }
    glm::dvec3 darkened(const glm::dvec3& color) const {
        const glm::dvec3 c = glm::clamp(color, 0.0, 1.0);
        return {darkened(c.x), darkened(c.y), darkened(c.z)};
    }

  private:
    double back_, bounces_, through_ = 0, inside_ = 0;
};

/// A diffuse base under an interface, with the colour of what light meets several times.
Surface coatedDiffuse(const SurfaceMaker& maker) {
    const Parameters& p = maker.parameters;
    Surface surface = maker.empty(MaterialKind::Plastic);
    Material& m = surface.material;
    m.ior = float(indexOf(maker.context, p, 1.5));
    m.isNonlinear = true;
    maker.facets(surface, "", 0);
    const double thickness = maker.number("thickness", 0.01, 0, 1e6);
    const double depth = p.number("maxdepth", 10, 1, 1e6);
    if (glm::dvec3(maker.plainColor("albedo", glm::dvec3(0))) != glm::dvec3(0))
        p.replace(build::Shortfall::Medium, "has a medium between interface and base");
    p.skip({"g", "nsamples"});
    const Layer layer(m.ior, thickness, std::max(depth / 2, 1.0));
    const Pattern stated = maker.pattern("reflectance", glm::dvec3(0.5));
    Pattern darker = stated;
    if (stated.isConstant) {
        darker.color = layer.darkened(stated.color);
    } else if (stated.texture) { // so much as in the mean: the share hardly depends on the colour
        const glm::dvec3 mean = glm::clamp(stated.mean(), 1e-3, 1.0);
        darker.color *= layer.darkened(mean) / mean;
    } else {
        combine(
            stated, Pattern(), Pattern(),
            [layer](const auto& color, const auto&, const auto&) { return layer.darkened(color); },
            darker);
    }
    maker.color(surface, darker, m.albedo, TextureSlot::BaseColor, "reflectance");
    return surface;
}

Surface conductor(const SurfaceMaker& maker) {
    Surface surface = maker.empty(MaterialKind::Conductor);
    Material& m = surface.material;
    maker.facets(surface, "", 0);
    if (!maker.parameters.has("reflectance")) {
        const build::MetalIndex index = metalOf(maker.context, maker.parameters, "eta", "k");
        m.eta = index.eta;
        m.k = index.k;
        return surface;
    }
    const Pattern reflectance = maker.pattern("reflectance", glm::dvec3(0.5));
    if (reflectance.isConstant) {
        const build::MetalIndex index =
            metalOfReflectance(glm::dvec3(maker.plainColor("reflectance", glm::dvec3(0.5))));
        m.eta = index.eta;
        m.k = index.k;
        return surface;
    }
    // A picture has no index of refraction: what it says is reflected in all directions alike.
    maker.parameters.replace(build::Shortfall::Model, "'reflectance' is a texture",
                             "the same reflectance at all angles");
    m.eta = glm::vec3(0);
    m.k = glm::vec3(1);
    maker.color(surface, reflectance, m.reflectance, TextureSlot::BaseColor, "reflectance");
    return surface;
}

/// glTF's metal with a clear coat.
Surface coatedConductor(const SurfaceMaker& maker) {
    const Parameters& p = maker.parameters;
    Surface surface = maker.empty(MaterialKind::Principled);
    PrincipledParameters& principled = surface.material.principled;
    maker.say("metal with a clear coat");
    const double ior = std::max(indexOf(maker.context, p, "interface.eta", 1.5), 1.0);
    const auto roughness = [&](const std::string& prefix) {
        maker.facets(surface, prefix, 0, false);
        const glm::vec2 alpha = surface.material.facets.alpha;
        return std::sqrt(std::clamp((alpha.x + alpha.y) / 2, 0.0f, 1.0f));
    };
    // The coat of glTF has the index 1.5. One of another index reflects as much when it is looked
    // at straight, but for those that reflect more.
    const double facing = (ior - 1) / (ior + 1);
    principled.clearcoat = float(std::min(facing * facing / 0.04, 1.0));
    principled.clearcoatRoughness = roughness("interface.");
    principled.roughness = roughness("conductor.");
    surface.material.facets = {};
    principled.metallic = 1;
    const double thickness = maker.number("thickness", 0.01, 0, 1e6);
    const double kept = std::exp(-2 * thickness);
    const bool isStated = p.has("reflectance");
    if (isStated && !maker.pattern("reflectance", glm::dvec3(0.5)).isConstant) {
        maker.color(surface, maker.pattern("reflectance", glm::dvec3(0.5)), principled.baseColor,
                    TextureSlot::BaseColor, "reflectance");
    } else {
        build::MetalIndex index = metalOf(maker.context, p, "conductor.eta", "conductor.k");
        if (isStated)
            index =
                metalOfReflectance(glm::dvec3(maker.plainColor("reflectance", glm::dvec3(0.5))));
        index.eta /= ior;
        index.k /= ior;
        principled.baseColor = glm::vec3(kept * glm::clamp(facingReflectance(index), 0.0, 1.0));
    }
    if (glm::dvec3(maker.plainColor("albedo", glm::dvec3(0))) != glm::dvec3(0))
        p.replace(build::Shortfall::Medium, "has a medium between interface and metal");
    p.skip({"g", "maxdepth", "nsamples"});
    return surface;
}

Surface dielectric(const SurfaceMaker& maker) {
    const bool isThin = maker.statement.kind == "thindielectric";
    Surface surface = maker.empty(isThin ? MaterialKind::ThinDielectric : MaterialKind::Dielectric);
    surface.material.ior = float(indexOf(maker.context, maker.parameters, 1.5));
    if (!isThin) maker.facets(surface, "", 0);
    maker.parameters.skip({"remaproughness"});
    return surface;
}

Surface measured(const SurfaceMaker& maker) {
    maker.parameters.skip({"filename"});
    return maker.replaced("mid grey");
}

} // namespace

bool makeV4(const SurfaceMaker& maker, Surface& surface) {
    struct Kind {
        std::string_view name;
        Surface (*make)(const SurfaceMaker&);
    };
    static constexpr Kind kKinds[] = {{"diffuse", diffuse},
                                      {"diffusetransmission", diffuseTransmission},
                                      {"coateddiffuse", coatedDiffuse},
                                      {"conductor", conductor},
                                      {"coatedconductor", coatedConductor},
                                      {"dielectric", dielectric},
                                      {"thindielectric", dielectric},
                                      {"measured", measured},
                                      {"subsurface", subsurface},
                                      {"hair", hair}};
    const auto* kind = std::ranges::find(kKinds, maker.statement.kind, &Kind::name);
    if (kind == std::end(kKinds)) return false;
    surface = kind->make(maker);
    return true;
}

} // namespace stromboli::pbrt
