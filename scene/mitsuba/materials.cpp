#include "scene/mitsuba/materials.hpp"

#include "scene/build/tolerate.hpp"
#include "scene/mitsuba/nested_bsdfs.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::mitsuba {

namespace {

/// In Mitsuba 0.4 and later a surface between two media is nothing else where it has no BSDF.
bool isBorderAlone(const Plugin& shape) {
    return shape.isOld && !shape.isAncient && !shape.childrenOf("medium").empty();
}

/// White, which the mesh of a part is not painted with: see Materials::of.
TextureImage unpainted(const Paint&) {
    return {"unpainted", 1, 1, TexelFormat::Rgba8, {0xFFFFFFFFu}};
}

} // namespace

BoundMaterial Materials::of(const Plugin& shape, const Painter& painter) {
    const Plugin* bsdf = shape.onlyChildOf("bsdf");
    const Plugin* emitter = shape.onlyChildOf("emitter");
    const auto key = std::tuple(bsdf, emitter, sidesOf(shape));
    if (const auto found = made_.find(key); found != made_.end()) return found->second;
    Surface surface = make(shape, bsdf, emitter);
    if (!wantsPaint(surface)) return made_.emplace(key, bind(std::move(surface))).first->second;
    paint(surface, shape, painter); // another material for each mesh
    return bind(std::move(surface));
}

BoundMaterial Materials::of(const Plugin& shape, const Plugin& bsdf) {
    const auto key = std::tuple(&bsdf, static_cast<const Plugin*>(nullptr), sidesOf(shape));
    if (const auto found = made_.find(key); found != made_.end()) return found->second;
    Surface surface = make(shape, &bsdf, nullptr);
    paint(surface, shape, unpainted);
    surface.cornerColors.clear();
    return made_.emplace(key, bind(std::move(surface))).first->second;
}

Surface Materials::make(const Plugin& shape, const Plugin* bsdf, const Plugin* emitter) {
    Surface surface;
    surface.material = build::greyMaterial();
    surface.material.isBlackBehind = !context_.document.isRainbows();
    if (emitter) surface.material.albedo = glm::vec3(0); // what shines reflects by its bsdf alone
    if (!emitter && isBorderAlone(shape)) {
        surface.material.alphaMode = AlphaMode::Blend;
        surface.material.opacity = 0;
    }
    if (bsdf) surface = readBsdf(context_, textures_, *bsdf);
    settleColors(surface);
    surround(surface, sidesOf(shape));
    if (emitter)
        for (Surface* each = &surface; each; each = each->other.get())
            build::tolerate(context_.report(), build::Shortfall::Node,
                            [&] { addEmission(*emitter, each->material); });
    return surface;
}

void Materials::surround(Surface& surface, const Sides& sides) {
    const uint32_t under = sides.under ? media_.under(*sides.under, surface.material) : kNoMedium;
    if (under != kNoMedium) {
        surface = Surface{surface.material, {}, {}, {}};
        surface.material.boundsMedia = true;
        surface.material.inside = under;
        surface.material.outside = media_.of(sides.outside);
        return;
    }
    if (!sides.areStated()) return;
    for (Surface* each = &surface; each; each = each->other.get()) {
        each->material.boundsMedia = true;
        each->material.inside = media_.of(sides.inside);
        each->material.outside = media_.of(sides.outside);
    }
}

/// Colours of corners multiply those of all materials of a mixture. Where not all are meant to have
/// the same ones, those that are have them as textures.
void Materials::settleColors(Surface& surface) {
    bool areAlike = true;
    for (const Surface* each = &surface; each; each = each->other.get())
        areAlike = areAlike && each->cornerColors == surface.cornerColors;
    if (areAlike) return;
    for (Surface* each = &surface; each; each = each->other.get()) {
        if (each->cornerColors.empty()) continue;
        std::vector<TextureUse>& textures = each->material.textures;
        each->cornerPaint.slot = TextureSlot::BaseColor;
        textures.push_back(each->cornerPaint);
        each->cornerColors.clear();
    }
}

bool Materials::wantsPaint(const Surface& surface) const {
    return std::ranges::any_of(
               surface.material.textures,
               [&](const TextureUse& use) { return textures_.paintOf(use.texture); }) ||
           (surface.other && wantsPaint(*surface.other));
}

void Materials::paint(Surface& surface, const Plugin& shape, const Painter& painter) {
    for (Surface* each = &surface; each; each = each->other.get())
        for (TextureUse& use : each->material.textures)
            if (const Paint* found = textures_.paintOf(use.texture)) {
                Paint paint = *found;
                paint.isFraction = use.slot == TextureSlot::BaseColor;
                use.texture = textures_.add(painter(paint), shape);
            }
}

BoundMaterial Materials::bind(Surface&& surface) {
    BoundMaterial bound;
    const Material& m = surface.material;
    // Paints alone have the second coordinates.
    const auto isPaint = [](const TextureUse& use) { return use.uvSet == 1; };
    bound.isTextured = !std::ranges::all_of(m.textures, isPaint);
    bound.isPainted = std::ranges::any_of(m.textures, isPaint);
    bound.cornerColors = surface.cornerColors;
    bound.wantsTangents = m.hasGrain() || std::ranges::any_of(m.textures, [](const auto& use) {
                              return use.slot == TextureSlot::Normal;
                          });
    if (surface.other) {
        const BoundMaterial other = bind(std::move(*surface.other));
        surface.material.other = other.number;
        bound.isTextured |= other.isTextured;
        bound.isPainted |= other.isPainted;
        bound.wantsTangents |= other.wantsTangents;
    }
    bound.number = context_.builder.addMaterial(std::move(surface.material));
    return bound;
}

/// A beam along the normals has no width: no path comes upon it, in Mitsuba either.
void Materials::ignoreBeam(const Plugin& emitter, Material& material) {
    context_.report().warn("emitter 'directionalarea' shines along its normals alone, which paths "
                           "from the camera never meet: it gives no light, as in Mitsuba's path");
    material.isHiddenFromCamera = context_.builder.hints().hidesBackdrop;
    for (const char* unused : {"radiance", "sampling_weight"})
        emitter.skip(unused);
    emitter.requireAllRead();
}

void Materials::addEmission(const Plugin& emitter, Material& material) {
    if (emitter.type == "directionalarea") return ignoreBeam(emitter, material);
    if (emitter.type != "area")
        emitter.fail(fmt::format("'{}' is no emitter of a shape that is read, expected area or "
                                 "directionalarea",
                                 emitter.type));
    const Shade radiance = textures_.shade(emitter, "radiance", ColorOf::Light, glm::dvec3(1));
    material.emission = context_.builder.lightColor("radiance", radiance.color);
    material.emitsBothSides = false;
    material.isHiddenFromCamera = context_.builder.hints().hidesBackdrop;
    if (radiance.texture) {
        TextureUse use = *radiance.texture;
        use.slot = TextureSlot::Emission;
        context_.builder.picturesOfEmissionAreLamps();
        material.textures.push_back(use);
    }
    emitter.skip("sampling_weight");
    emitter.requireAllRead();
}

} // namespace stromboli::mitsuba
