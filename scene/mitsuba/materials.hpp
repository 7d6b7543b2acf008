#pragma once

#include "scene/mitsuba/bsdfs.hpp"
#include "scene/mitsuba/media.hpp"

#include <functional>
#include <map>
#include <string>
#include <tuple>

namespace stromboli::mitsuba {

/// A material of the scene, and what it wants from the corners of its triangles.
struct BoundMaterial {
    uint32_t number = 0;
    bool isTextured = false, wantsTangents = false;
    bool isPainted = false;   ///< with textures by the second coordinates (corner_paint.hpp)
    std::string cornerColors; ///< the mesh attribute that corners have colours by; empty: none

    bool wantsCoordinates() const { return isTextured || wantsTangents; }
};

/// The materials of a scene: one for each BSDF and emitter that a shape has.
class Materials {
  public:
    explicit Materials(Context& context) : context_(context), textures_(context), media_(context) {}

    /// The picture that a shape's mesh is painted with.
    using Painter = std::function<TextureImage(const Paint&)>;

    /// The material of a shape, which may have neither a BSDF nor an emitter.
    BoundMaterial of(const Plugin& shape, const Painter& painter);
    /// The material of a part of a shape that has that BSDF, and no mesh attributes.
    BoundMaterial of(const Plugin& shape, const Plugin& bsdf);

    Media& media() { return media_; }

  private:
    Surface make(const Plugin& shape, const Plugin* bsdf, const Plugin* emitter);
    BoundMaterial bind(Surface&& surface);
    /// Says what is on both sides of a surface, if anything is.
    void surround(Surface& surface, const Sides& sides);
    static void settleColors(Surface& surface);
    bool wantsPaint(const Surface& surface) const;
    void paint(Surface& surface, const Plugin& shape, const Painter& painter);
    void ignoreBeam(const Plugin& emitter, Material& material);
    void addEmission(const Plugin& emitter, Material& material);

    Context& context_;
    Textures textures_;
    Media media_;
    /// By BSDF, emitter, and what is on both sides.
    std::map<std::tuple<const Plugin*, const Plugin*, Sides>, BoundMaterial> made_;
};

} // namespace stromboli::mitsuba
