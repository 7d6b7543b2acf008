#include "scene/pbrt/materials.hpp"

#include "scene/build/tolerate.hpp"
#include "scene/pbrt/surface_maker.hpp"

#include <algorithm>

namespace stromboli::pbrt {

BoundMaterial Materials::of(const std::shared_ptr<const MaterialStatement>& statement,
                            const Names& ofScene, const Parameters& shape,
                            const std::optional<Emission>& emission,
                            const std::optional<Pattern>& alpha, const MediumSides& media) {
    std::vector<Parameter> overriding;
    if (context_.isV3()) overriding = shape.unread();
    const bool isPlain = overriding.empty() && !emission && (!alpha || alpha->number > 0);
    const std::tuple key(statement.get(), alpha ? alpha->number : 0, media);
    if (const auto found = made_.find(key); isPlain && found != made_.end()) return found->second;
    MaterialStatement changed = *statement;
    changed.parameters.prepend(overriding);
    if (changed.parameters.place().file.empty()) changed.parameters.placeAt(shape.place());
    Surface surface;
    surface.material = build::greyMaterial();
    build::tolerate(context_.report(), build::Shortfall::Material,
                    [&] { surface = SurfaceMaker(context_, textures_, changed, ofScene).make(); });
    for (const Parameter& parameter : overriding) // the material's reading is said there
        shape.skip({parameter.name});
    if (emission)
        surface.each([&](Material& material) {
            material.emission = emission->radiance;
            material.emitsBothSides = emission->onBothSides;
            if (emission->picture) material.textures.push_back(*emission->picture);
        });
    const bool isThere =
        surface.material.alphaMode != AlphaMode::Blend || surface.material.opacity > 0;
    if (emission && !isThere) { // a surface that is not there would not shine
        surface = Surface{surface.material, nullptr, surface.mapping};
        surface.material.alphaMode = AlphaMode::Opaque;
        surface.material.opacity = 1;
    }
    if (alpha) setAlpha(surface, *alpha);
    // A surface within one medium leaves rays in the medium that they are in.
    if (media.isStated && media.inside != media.outside)
        surface.each([&](Material& material) {
            material.boundsMedia = true;
            material.inside = media.inside;
            material.outside = media.outside;
        });
    for (Surface* each = &surface; each; each = each->other.get()) {
        if (!each->under) continue;
        each->material.boundsMedia = true;
        each->material.inside = context_.builder.addMedium(*each->under);
        each->material.outside = media.isStated ? media.outside : kNoMedium;
    }
    const BoundMaterial bound = bind(std::move(surface));
    if (isPlain) {
        made_.emplace(key, bound);
        kept_.push_back(statement);
    }
    return bound;
}

/// pbrt-v3 has a surface wherever alpha is not 0, pbrt-v4 in a share of cases.
void Materials::setAlpha(Surface& surface, const Pattern& alpha) {
    Material& m = surface.material;
    const bool isTested = context_.isV3();
    const Remap remap =
        isTested ? Remap([](const glm::dvec3& value) { return glm::dvec3(value.x > 0 ? 1 : 0); })
                 : nullptr;
    const Shade shade = textures_.shade(alpha, remap, build::Layout::Red);
    if (m.alphaMode == AlphaMode::Opaque) {
        m.alphaMode = isTested ? AlphaMode::Mask : AlphaMode::Blend;
        m.opacity = 1;
    }
    m.opacity *= float(std::clamp(shade.color.x, 0.0, 1.0));
    if (!shade.texture) return;
    if (shade.mapping) surface.mapping = shade.mapping;
    TextureUse use = *shade.texture;
    use.slot = TextureSlot::Opacity;
    m.textures.push_back(use);
}

BoundMaterial Materials::bind(Surface&& surface) {
    BoundMaterial bound;
    Material& m = surface.material;
    bound.mapping = surface.mapping;
    bound.wantsCoordinates = !m.textures.empty();
    bound.wantsTangents =
        m.hasGrain() || std::ranges::any_of(m.textures, [](const TextureUse& use) {
            return use.slot == TextureSlot::Normal;
        });
    bound.isTransparent = m.boundsMedia || m.kind == MaterialKind::Dielectric ||
                          (m.kind == MaterialKind::Burley && m.burley.transmits());
    if (surface.other) {
        const BoundMaterial other = bind(std::move(*surface.other));
        m.other = other.number;
        bound.wantsCoordinates |= other.wantsCoordinates;
        bound.wantsTangents |= other.wantsTangents;
        bound.isTransparent |= other.isTransparent;
        if (!bound.mapping) bound.mapping = other.mapping;
    }
    bound.number = context_.builder.addMaterial(std::move(m));
    return bound;
}

} // namespace stromboli::pbrt
