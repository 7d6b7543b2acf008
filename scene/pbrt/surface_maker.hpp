#pragma once

#include "scene/pbrt/materials.hpp"

#include <string_view>
#include <vector>

namespace stromboli::pbrt {

/// Makes a surface of what a material's parameters say.
class SurfaceMaker {
  public:
    SurfaceMaker(Context& whole, Textures& textures, const MaterialStatement& ofFile,
                 const Names& ofScene, size_t depth = 0)
        : context(whole), statement(ofFile), parameters(ofFile.parameters), textures_(textures),
          ofScene_(ofScene), names_(ofScene), depth_(depth) {
        if (context.isV3()) names_ = {statement.textures.get(), statement.named.get()};
    }

    /// Throws SceneError for a kind that is none.
    Surface make();

    Context& context;
    const MaterialStatement& statement;
    const Parameters& parameters;

    Pattern pattern(std::string_view name, const glm::dvec3& otherwise,
                    ColorOf what = ColorOf::Reflectance, bool isNumber = false) const;
    /// A reflected or transmitted fraction into a material, or a texture of it in that slot.
    void color(Surface& surface, const Pattern& pattern, glm::vec3& where, TextureSlot slot,
               std::string_view name) const;
    /// Makes it where there is one colour for all of the surface.
    glm::vec3 plainColor(std::string_view name, const glm::dvec3& otherwise) const;
    /// A number in [least, most]; of a texture its mean, which is said.
    double number(std::string_view name, double otherwise, double least, double most) const;
    /// A number in [0, 1], or a texture of it in that slot.
    float fraction(Surface& surface, std::string_view name, double otherwise, TextureSlot slot,
                   build::Layout layout) const;
    /// Microfacets by `roughness`, or by `uroughness` and `vroughness`.
    void facets(Surface& surface, const std::string& prefix, double otherwise,
                bool mayHaveTextures = true) const;
    void say(const std::string& instead) const;

    /// Parts that are added. A path meets one of them, in a share of cases, and it is made so much
    /// stronger that the sum is the same.
    struct Lobe {
        Surface surface;
        double most = 0;       ///< of what it reflects
        bool isGlossy = false; ///< by an interface that reflects little but at grazing angles
    };
    Surface sum(std::vector<Lobe> lobes) const;
    /// All diffuse light goes through to the other side.
    Surface diffuseTransmitter(const Pattern& transmitted) const;
    /// Nothing yet, of a kind.
    Surface empty(MaterialKind kind) const;
    Surface replaced(std::string_view kind) const;

  private:
    Surface interface() const;
    Surface mix() const;
    void addRelief(Surface& surface) const;
    double alphaOf(double roughness, bool isRemapped) const;

    Textures& textures_;
    Names ofScene_, names_;
    size_t depth_;
};

/// Those of one version each; false where the kind is none of them.
bool makeV3(const SurfaceMaker& maker, Surface& surface);
bool makeV4(const SurfaceMaker& maker, Surface& surface);

} // namespace stromboli::pbrt
