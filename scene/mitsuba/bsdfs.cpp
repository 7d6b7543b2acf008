#include "scene/mitsuba/bsdfs.hpp"

#include "scene/mitsuba/media_tables.hpp"
#include "scene/mitsuba/principled.hpp"
#include "scene/mitsuba/surface_maker.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::mitsuba {
namespace {

Surface readInside(SurfaceMaker& maker, Context& context, Textures& textures) {
    const Plugin* inside = maker.plugin.onlyChildOf("bsdf");
    if (!inside) maker.plugin.fail("has no bsdf inside, expected one");
    return readBsdf(context, textures, *inside);
}

/// A texture of all materials that a mixture is of.
void addTexture(Surface& surface, const TextureUse& use) {
    for (Surface* each = &surface; each; each = each->other.get())
        each->material.textures.push_back(use);
}

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
    if (type == "roughdielectric") maker.facets();
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
    if (maker.plugin.type == "roughconductor") maker.facets();
    maker.color("specular_reflectance", glm::dvec3(1), m.reflectance, TextureSlot::BaseColor);
    return maker.done();
}

Surface plastic(SurfaceMaker& maker) {
    Material& m = maker.material;
    m.kind = MaterialKind::Plastic;
    m.ior = float(refractiveIndex(maker.plugin, "int_ior", "polypropylene") /
                  refractiveIndex(maker.plugin, "ext_ior", "air"));
    m.isNonlinear = maker.plugin.flag("nonlinear").value_or(false);
    if (maker.plugin.type == "roughplastic") maker.facets();
    m.internalViews = 64;
    maker.color("diffuse_reflectance", glm::dvec3(0.5), m.albedo, TextureSlot::BaseColor);
    maker.color("specular_reflectance", glm::dvec3(1), m.reflectance, TextureSlot::SpecularColor);
    return maker.done();
}

const TextureUse* opacityTexture(const Material& m) {
    const auto found = std::ranges::find(m.textures, TextureSlot::Opacity, &TextureUse::slot);
    return found == m.textures.end() ? nullptr : &*found;
}

/// Of a mixture, which is there as often as its first material.
double opacityOf(const Material& m) {
    return m.alphaMode == AlphaMode::Opaque ? 1.0 : double(m.opacity);
}

/// A surface with another one behind. What is a mixture takes the place of what is none.
Surface withBack(const Plugin& plugin, Surface front, Surface back) {
    if (front.other && back.other)
        plugin.fail("has two bsdfs that are blends, expected one at most");
    if (opacityOf(front.material) != opacityOf(back.material) || opacityTexture(front.material) ||
        opacityTexture(back.material))
        plugin.fail("has masks inside, expected the mask around the two-sided bsdf");
    OtherPlace place = OtherPlace::Behind;
    if (front.other) {
        std::swap(front, back);
        place = OtherPlace::InFront;
    }
    front.material.otherPlace = place;
    front.material.otherShare = 1;
    front.other = std::make_shared<Surface>(std::move(back));
    return front;
}

/// The back is the front's mirror image, or a bsdf of its own.
Surface twoSided(SurfaceMaker& maker, Context& context, Textures& textures) {
    const std::vector<const Plugin*> inside = maker.plugin.childrenOf("bsdf");
    if (inside.empty() || inside.size() > 2)
        maker.plugin.fail(fmt::format("has {} bsdfs inside, expected one or two", inside.size()));
    maker.plugin.requireAllRead();
    Surface surface = readBsdf(context, textures, *inside.front());
    if (inside.back() != inside.front())
        surface =
            withBack(maker.plugin, std::move(surface), readBsdf(context, textures, *inside.back()));
    for (Surface* each = &surface; each; each = each->other.get())
        each->material.isBlackBehind = false;
    return surface;
}

/// Lets a surface be there as often as a picture says, or its negative.
void addOpacity(const Plugin& plugin, Material& m, TextureUse picture, bool isNegative) {
    if (opacityTexture(m)) plugin.fail("is a mask over one whose opacity is a texture");
    picture.slot = TextureSlot::Opacity;
    picture.scale = isNegative ? -1 : 1;
    m.alphaMode = AlphaMode::Blend;
    m.textures.push_back(picture);
}

Surface mask(SurfaceMaker& maker, Context& context, Textures& textures) {
    Surface surface = readInside(maker, context, textures);
    Material& m = surface.material;
    const Shade opacity =
        textures.shade(maker.plugin, "opacity", ColorOf::Reflectance, glm::dvec3(0.5), Layout::Red);
    m.opacity =
        float(opacityOf(m) *
              std::clamp((opacity.color.x + opacity.color.y + opacity.color.z) / 3, 0.0, 1.0));
    m.alphaMode = AlphaMode::Blend;
    if (opacity.texture) addOpacity(maker.plugin, m, *opacity.texture, false);
    maker.plugin.requireAllRead();
    return surface;
}

/// A surface that is not there.
Surface nothing(SurfaceMaker& maker) {
    maker.material.kind = MaterialKind::Diffuse;
    maker.material.albedo = glm::vec3(0);
    maker.material.alphaMode = AlphaMode::Blend;
    maker.material.opacity = 0;
    return maker.done();
}

/// How Mitsuba shades what a map has turned.
void setReliefRules(Surface& surface, const Plugin& plugin) {
    const bool flips = plugin.flag("flip_invalid_normals").value_or(true);
    const bool shadows = plugin.flag("use_shadowing_function").value_or(true);
    for (Surface* each = &surface; each; each = each->other.get()) {
        each->material.reliefRule = flips ? ReliefRule::Flip : ReliefRule::Blacken;
        each->material.reliefShadows = shadows;
    }
}

Surface normalMap(SurfaceMaker& maker, Context& context, Textures& textures) {
    Surface surface = readInside(maker, context, textures);
    const Shade normals =
        textures.shade(maker.plugin, "normalmap", ColorOf::Reflectance, glm::dvec3(0.5, 0.5, 1));
    if (!normals.texture || !normals.attribute.empty())
        maker.plugin.fail("has no texture 'normalmap'");
    TextureUse use = *normals.texture;
    use.slot = TextureSlot::Normal;
    addTexture(surface, use);
    setReliefRules(surface, maker.plugin);
    maker.plugin.requireAllRead();
    return surface;
}

Surface bumpMap(SurfaceMaker& maker, Context& context, Textures& textures) {
    Surface surface = readInside(maker, context, textures);
    for (const Surface* each = &surface; each; each = each->other.get())
        for (const TextureUse& use : each->material.textures)
            if (use.slot == TextureSlot::Normal || use.slot == TextureSlot::Height)
                maker.plugin.fail(
                    "is a bump map over another map of normals, which is not supported");
    const Plugin* heights = maker.plugin.onlyChildOf("texture");
    if (!heights) maker.plugin.fail("has no texture inside, expected one of heights");
    const Shade shade = textures.texture(*heights, ColorOf::Reflectance, Layout::Grey);
    if (!shade.texture || !shade.attribute.empty())
        heights->fail("is no picture, expected one of heights");
    TextureUse use = *shade.texture;
    use.slot = TextureSlot::Height;
    use.scale = float(maker.plugin.number("scale").value_or(1));
    addTexture(surface, use);
    setReliefRules(surface, maker.plugin);
    maker.plugin.requireAllRead();
    return surface;
}

/// Of two surfaces, either of which may be there in a share of cases only, the mixture is there in
/// the mean of both shares, and then the second one as often as it is one of those.
void takeMasksOut(const Plugin& plugin, Material& first, Material& second, bool hasTexture,
                  double& weight) {
    const bool haveTextures = opacityTexture(first) || opacityTexture(second);
    const double a = opacityOf(first), b = opacityOf(second);
    if (a == 1 && b == 1 && !haveTextures) return;
    if (hasTexture || haveTextures)
        plugin.fail("has a mask inside, and a weight or an opacity that is a texture, expected the "
                    "mask around the blend");
    const double opacity = (1 - weight) * a + weight * b;
    weight = opacity > 0 ? weight * b / opacity : 0;
    first.alphaMode = AlphaMode::Blend;
    first.opacity = float(opacity);
    second.alphaMode = AlphaMode::Opaque;
    second.opacity = 1;
}

bool isNothing(const Surface& surface) {
    return !surface.other && opacityOf(surface.material) == 0;
}

/// A blend with nothing is a mask: it is there where it is not nothing.
Surface blendWithNothing(const Plugin& plugin, Surface surface, const Shade& share, double weight,
                         bool isSecond) {
    Material& m = surface.material;
    m.opacity = float(opacityOf(m) * (share.texture ? 1 : isSecond ? weight : 1 - weight));
    m.alphaMode = AlphaMode::Blend;
    if (share.texture) addOpacity(plugin, m, *share.texture, !isSecond);
    plugin.requireAllRead();
    return surface;
}

/// One of two bsdfs, the second one in the share of cases that `weight` says.
Surface blend(SurfaceMaker& maker, Context& context, Textures& textures) {
    const Plugin& plugin = maker.plugin;
    const std::vector<const Plugin*> inside = plugin.childrenOf("bsdf");
    if (inside.size() != 2)
        plugin.fail(fmt::format("has {} bsdfs inside, expected two", inside.size()));
    Surface first = readBsdf(context, textures, *inside[0]);
    auto second = std::make_shared<Surface>(readBsdf(context, textures, *inside[1]));
    const Shade share =
        textures.shade(plugin, "weight", ColorOf::Reflectance, glm::dvec3(0.5), Layout::Red);
    double weight = std::clamp((share.color.x + share.color.y + share.color.z) / 3, 0.0, 1.0);
    if (isNothing(first)) return blendWithNothing(plugin, std::move(*second), share, weight, true);
    if (isNothing(*second)) return blendWithNothing(plugin, std::move(first), share, weight, false);
    takeMasksOut(plugin, first.material, second->material, share.texture.has_value(), weight);
    if (first.other) { // only what takes the place may be a mixture in turn
        if (second->other || share.texture)
            plugin.fail("has a first bsdf that is a blend, which is not supported here");
        std::swap(first, *second);
        std::swap(first.material.alphaMode, second->material.alphaMode);
        std::swap(first.material.opacity, second->material.opacity);
        weight = 1 - weight;
    }
    if (share.texture) {
        TextureUse use = *share.texture;
        use.slot = TextureSlot::BlendShare;
        first.material.textures.push_back(use);
    }
    first.material.otherShare = float(weight);
    first.other = std::move(second);
    plugin.requireAllRead();
    return first;
}

} // namespace

Surface readBsdf(Context& context, Textures& textures, const Plugin& bsdf) {
    SurfaceMaker maker(bsdf, textures, context);
    const std::string& type = bsdf.type;
    if (type == "diffuse") return diffuse(maker);
    if (type == "dielectric" || type == "roughdielectric" || type == "thindielectric")
        return dielectric(maker);
    if (type == "conductor" || type == "roughconductor") return conductor(maker);
    if (type == "plastic" || type == "roughplastic") return plastic(maker);
    if (type == "principled") return principled(maker);
    if (type == "principledthin") return principledThin(maker);
    if (type == "twosided") return twoSided(maker, context, textures);
    if (type == "mask") return mask(maker, context, textures);
    if (type == "null") return nothing(maker);
    if (type == "normalmap") return normalMap(maker, context, textures);
    if (type == "bumpmap") return bumpMap(maker, context, textures);
    if (type == "blendbsdf") return blend(maker, context, textures);
    bsdf.fail(fmt::format("'{}' is no bsdf that is read, expected diffuse, dielectric, "
                          "thindielectric, roughdielectric, conductor, roughconductor, plastic, "
                          "roughplastic, principled, principledthin, twosided, mask, null, "
                          "normalmap, bumpmap or blendbsdf",
                          type));
}

} // namespace stromboli::mitsuba
