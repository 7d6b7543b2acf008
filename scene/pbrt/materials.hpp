#pragma once

#include "scene/pbrt/media.hpp"
#include "scene/pbrt/textures.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace stromboli::pbrt {

struct MaterialStatement;
using MaterialTable = std::map<std::string, std::shared_ptr<const MaterialStatement>>;

/// A material as the file states it, with the names that it may refer to.
struct MaterialStatement {
    std::string kind; ///< "" and "none" of pbrt-v3 are "interface"
    Parameters parameters;
    std::shared_ptr<const TextureTable> textures;
    std::shared_ptr<const MaterialTable> named;
};

/// The names that a material may refer to: in pbrt-v3 those before it, in pbrt-v4 those of the
/// whole scene.
struct Names {
    const TextureTable* textures = nullptr;
    const MaterialTable* materials = nullptr;
};

/// What a material of the file makes of a surface.
struct Surface {
    Material material;
    std::shared_ptr<Surface> other;      ///< Material::other of its material
    std::optional<Mapping> mapping;      ///< of its textures by the second coordinates
    std::shared_ptr<const Medium> under; ///< what scatters under it, where that is a medium

    /// Its materials, one after the other.
    template <typename Do>
    void each(Do&& handle) {
        for (Surface* one = this; one; one = one->other.get())
            handle(one->material);
    }
};

/// What a surface emits, of an area light.
struct Emission {
    glm::vec3 radiance{0.0f};
    bool onBothSides = false;
    std::optional<TextureUse> picture;
};

/// A material of the scene, and what it wants from the corners of its triangles.
struct BoundMaterial {
    uint32_t number = 0;
    bool wantsCoordinates = false, wantsTangents = false;
    bool isTransparent = false; ///< light goes through it, or to other media: its sides differ
    std::optional<Mapping> mapping;
};

/// The materials of a scene.
class Materials {
  public:
    Materials(Context& context, Textures& textures) : context_(context), textures_(textures) {}

    /// The material of a shape, whose own parameters take the place of the material's in pbrt-v3;
    /// alpha: how much of it is there.
    BoundMaterial of(const std::shared_ptr<const MaterialStatement>& statement,
                     const Names& ofScene, const Parameters& shape,
                     const std::optional<Emission>& emission, const std::optional<Pattern>& alpha,
                     const MediumSides& media);

  private:
    void setAlpha(Surface& surface, const Pattern& alpha);
    BoundMaterial bind(Surface&& surface);

    Context& context_;
    Textures& textures_;
    /// By the statement, the number of the texture that alpha is, and what is on both sides; of
    /// shapes that say nothing more.
    std::map<std::tuple<const MaterialStatement*, uint32_t, MediumSides>, BoundMaterial> made_;
    /// They are kept, so that the addresses in made_ stay theirs.
    std::vector<std::shared_ptr<const MaterialStatement>> kept_;
};

} // namespace stromboli::pbrt
