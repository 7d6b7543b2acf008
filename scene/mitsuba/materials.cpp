#include "scene/mitsuba/materials.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::mitsuba {

const BoundMaterial& Materials::of(const Plugin& shape) {
    const Plugin* bsdf = shape.onlyChildOf("bsdf");
    const Plugin* emitter = shape.onlyChildOf("emitter");
    const auto key = std::tuple(bsdf, emitter, shape.isOld);
    if (const auto found = made_.find(key); found != made_.end()) return found->second;
    return made_.emplace(key, make(bsdf, emitter, shape.isOld)).first->second;
}

BoundMaterial Materials::make(const Plugin* bsdf, const Plugin* emitter, bool isOld) {
    Surface surface;
    surface.material = build::greyMaterial();
    surface.material.isBlackBehind = !isOld;
    if (emitter) surface.material.albedo = glm::vec3(0); // what shines reflects by its bsdf alone
    if (bsdf) surface = readBsdf(context_, textures_, *bsdf);
    return bind(std::move(surface), emitter);
}

BoundMaterial Materials::bind(Surface&& surface, const Plugin* emitter) {
    if (emitter) addEmission(*emitter, surface.material);
    BoundMaterial bound;
    const Material& m = surface.material;
    bound.isTextured = !m.textures.empty();
    bound.meshColors = surface.meshColors;
    bound.wantsTangents = m.hasGrain() || std::ranges::any_of(m.textures, [](const auto& use) {
                              return use.slot == TextureSlot::Normal;
                          });
    if (surface.other) {
        const BoundMaterial other = bind(std::move(*surface.other), emitter);
        surface.material.other = other.number;
        bound.isTextured |= other.isTextured;
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
    if (radiance.mesh != MeshColors::None)
        emitter.fail("radiance", "is a mesh attribute, expected a colour or a picture");
    material.emission = context_.builder.lightColor("radiance", radiance.color);
    material.emitsBothSides = false;
    material.isHiddenFromCamera = context_.builder.hints().hidesBackdrop;
    if (radiance.texture) {
        TextureUse use = *radiance.texture;
        use.slot = TextureSlot::Emission;
        material.textures.push_back(use);
    }
    emitter.skip("sampling_weight");
    emitter.requireAllRead();
}

} // namespace stromboli::mitsuba
