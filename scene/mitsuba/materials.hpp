#pragma once

#include "scene/mitsuba/bsdfs.hpp"

#include <map>
#include <utility>

namespace stromboli::mitsuba {

/// A material of the scene, and what it wants from the corners of its triangles.
struct BoundMaterial {
    uint32_t number = 0;
    bool isTextured = false, wantsTangents = false, usesVertexColors = false;
    bool hasBlackBack = false; ///< in Mitsuba (Surface::hasBlackBack)

    bool wantsCoordinates() const { return isTextured || wantsTangents; }
};

/// The materials of a scene: one for each BSDF and emitter that a shape has.
class Materials {
  public:
    explicit Materials(Context& context) : context_(context), textures_(context) {}

    /// Of a shape with that BSDF and that emitter, either of which may be missing.
    const BoundMaterial& of(const Plugin* bsdf, const Plugin* emitter);

  private:
    BoundMaterial make(const Plugin* bsdf, const Plugin* emitter);
    void addEmission(const Plugin& emitter, Material& material);

    Context& context_;
    Textures textures_;
    std::map<std::pair<const Plugin*, const Plugin*>, BoundMaterial> made_;
};

} // namespace stromboli::mitsuba
