#pragma once

#include "scene/mitsuba/bsdfs.hpp"

#include <map>
#include <tuple>

namespace stromboli::mitsuba {

/// A material of the scene, and what it wants from the corners of its triangles.
struct BoundMaterial {
    uint32_t number = 0;
    bool isTextured = false, wantsTangents = false;
    MeshColors meshColors = MeshColors::None;

    bool wantsCoordinates() const { return isTextured || wantsTangents; }
};

/// The materials of a scene: one for each BSDF and emitter that a shape has.
class Materials {
  public:
    explicit Materials(Context& context) : context_(context), textures_(context) {}

    /// Of a shape, which may have neither a BSDF nor an emitter.
    const BoundMaterial& of(const Plugin& shape);

  private:
    BoundMaterial make(const Plugin* bsdf, const Plugin* emitter, bool isOld);
    BoundMaterial bind(Surface&& surface, const Plugin* emitter);
    void ignoreBeam(const Plugin& emitter, Material& material);
    void addEmission(const Plugin& emitter, Material& material);

    Context& context_;
    Textures textures_;
    std::map<std::tuple<const Plugin*, const Plugin*, bool>, BoundMaterial> made_;
};

} // namespace stromboli::mitsuba
