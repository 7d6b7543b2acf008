#include "scene/mitsuba/bsdfs.hpp"

#include "scene/build/tolerate.hpp"
#include "scene/mitsuba/media_tables.hpp"
#include "scene/mitsuba/nested_bsdfs.hpp"
#include "scene/mitsuba/principled.hpp"
#include "scene/mitsuba/replaced_bsdfs.hpp"
#include "scene/mitsuba/surface_maker.hpp"

#include <fmt/format.h>

#include <optional>

namespace stromboli::mitsuba {
namespace {

Surface diffuse(SurfaceMaker& maker) {
    maker.material.kind = MaterialKind::Diffuse;
    maker.color("reflectance", glm::dvec3(0.5), maker.material.albedo, TextureSlot::BaseColor);
    return maker.done();
}

Surface dielectric(SurfaceMaker& maker) {
    const std::string& type = maker.plugin.type;
    Material& m = maker.material;
    m.ior = float(refractiveIndex(maker.plugin, "int_ior", "bk7") /
                  refractiveIndex(maker.plugin, "ext_ior", "air"));
    m.kind = type == "thindielectric" ? MaterialKind::ThinDielectric : MaterialKind::Dielectric;
    if (type == "roughdielectric") maker.facets(true);
    // A picture needs facets: a smooth interface is glass without textures.
    const bool mayHavePictures = type != "dielectric";
    if (mayHavePictures) {
        maker.color("specular_reflectance", glm::dvec3(1), m.reflectance,
                    TextureSlot::SpecularColor);
        maker.color("specular_transmittance", glm::dvec3(1), m.transmittance,
                    TextureSlot::BaseColor);
    } else {
        maker.plainColor("specular_reflectance", glm::dvec3(1), m.reflectance);
        maker.plainColor("specular_transmittance", glm::dvec3(1), m.transmittance);
    }
    return maker.done();
}

Surface conductor(SurfaceMaker& maker) {
    Material& m = maker.material;
    m.kind = MaterialKind::Conductor;
    const MetalIndex metal = metalIndex(maker.plugin);
    m.eta = metal.eta;
    m.k = metal.k;
    if (maker.plugin.type == "roughconductor") maker.facets(true);
    maker.color("specular_reflectance", glm::dvec3(1), m.reflectance, TextureSlot::BaseColor);
    return maker.done();
}

Surface plastic(SurfaceMaker& maker) {
    Material& m = maker.material;
    m.kind = MaterialKind::Plastic;
    m.ior = float(refractiveIndex(maker.plugin, "int_ior", "polypropylene") /
                  refractiveIndex(maker.plugin, "ext_ior", "air"));
    m.isNonlinear = maker.plugin.flag("nonlinear").value_or(false);
    if (maker.plugin.type != "plastic") maker.facets(false); // a table of one alpha
    m.internalViews = 64;
    maker.color("diffuse_reflectance", glm::dvec3(0.5), m.albedo, TextureSlot::BaseColor);
    maker.color("specular_reflectance", glm::dvec3(1), m.reflectance, TextureSlot::SpecularColor);
    return maker.done();
}

/// A surface that is not there.
Surface nothing(SurfaceMaker& maker) {
    maker.material.kind = MaterialKind::Diffuse;
    maker.material.albedo = glm::vec3(0);
    maker.material.alphaMode = AlphaMode::Blend;
    maker.material.opacity = 0;
    return maker.done();
}

/// Mixtures that name another one twice, which does so too, hold 2^n bsdfs.
constexpr size_t kMostBsdfs = 1'000'000;

Surface readModel(Context& context, Textures& textures, const Plugin& bsdf) {
    if (++context.bsdfsRead > kMostBsdfs)
        bsdf.fail(fmt::format("is one of more than {} bsdfs inside each other", kMostBsdfs));
    SurfaceMaker maker(bsdf, textures, context);
    const std::string& type = bsdf.type;
    // How samples are taken, and not what of.
    if (bsdf.isOld) bsdf.skip("specular_sampling_weight");
    if (type == "diffuse") return diffuse(maker);
    if (type == "dielectric" || type == "roughdielectric" || type == "thindielectric")
        return dielectric(maker);
    if (type == "conductor" || type == "roughconductor") return conductor(maker);
    // Without polarisation pplastic is roughplastic.
    if (type == "plastic" || type == "roughplastic" || type == "pplastic") return plastic(maker);
    if (type == "principled") return principled(maker);
    if (type == "principledthin") return principledThin(maker);
    if (type == "null") return nothing(maker);
    if (type == "twosided") return twoSided(context, textures, bsdf);
    if (type == "mask") return mask(context, textures, bsdf);
    if (type == "normalmap") return normalMap(context, textures, bsdf);
    if (type == "bumpmap") return bumpMap(context, textures, bsdf);
    if (type == "blendbsdf") return blend(context, textures, bsdf);
    if (type == "mixturebsdf") return mixture(context, textures, bsdf);
    return replacedBsdf(context, textures, bsdf);
}

} // namespace

Surface readBsdf(Context& context, Textures& textures, const Plugin& bsdf) {
    std::optional<Surface> surface;
    if (build::tolerate(context.report(), build::Shortfall::Material,
                        [&] { surface = readModel(context, textures, bsdf); }))
        return *std::move(surface);
    Surface grey;
    grey.material = build::greyMaterial();
    return grey;
}

} // namespace stromboli::mitsuba
