#pragma once

#include "scene/mitsuba/bsdfs.hpp"

#include <optional>

namespace stromboli::mitsuba {

/// Fills in the material of one BSDF from its parameters.
class SurfaceMaker {
  public:
    SurfaceMaker(const Plugin& bsdf, Textures& textures, Context& context)
        : plugin(bsdf), textures_(textures), context_(context) {
        material.name = bsdf.displayName();
    }

    const Plugin& plugin;
    Material material;

    /// A reflected or transmitted fraction, or a texture of it in that slot.
    void color(const char* name, const glm::dvec3& otherwise, glm::vec3& where, TextureSlot slot);
    /// Makes it of what has been read.
    void put(const char* name, const Shade& shade, glm::vec3& where, TextureSlot slot);
    /// Makes it where no texture is possible: the mean of one is taken.
    void plainColor(const char* name, const glm::dvec3& otherwise, glm::vec3& where);
    /// A number in [0, most], or a texture of it in that slot, where `layout` puts it.
    float fraction(const char* name, double otherwise, TextureSlot slot, Layout layout,
                   double most = 1);
    /// The distribution and the roughness of microfacets. Where these may not have textures, the
    /// mean of one is taken.
    void facets(bool mayHaveTextures);
    build::Report& report() { return context_.report(); }

    /// Says which parameters were not read.
    Surface done();

  private:
    /// The roughness of facets: a number, a texture whose values `layout` puts, or its mean.
    float alpha(const char* name, double otherwise, std::optional<Layout> layout);
    void sayMean(const char* name);

    Textures& textures_;
    Context& context_;
    std::string cornerColors_; ///< a mesh attribute
    TextureUse cornerPaint_;
};

} // namespace stromboli::mitsuba
