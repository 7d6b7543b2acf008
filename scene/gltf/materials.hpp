#pragma once

#include "scene/gltf/textures.hpp"

#include <map>
#include <optional>

namespace stromboli::gltf {

/// A material of the scene, and what it wants from the corners of its triangles.
struct BoundMaterial {
    uint32_t number = 0;
    UvSets uvSets;
    bool isTextured = false;
    /// The material itself, where it is unlit, so that colours of corners can be added to it.
    std::optional<Material> unlit;
    /// Which of the two sets of texture coordinates tangents follow; nothing if none are needed.
    std::optional<int> tangentSet;
    /// How KHR_texture_transform turns and mirrors the picture that the tangents are for.
    glm::dvec2 tangentRows[2] = {{1, 0}, {0, 1}};
};

/// The materials of a file, each of which is read when a mesh uses it.
class Materials {
  public:
    explicit Materials(Context& context) : context_(context), textures_(context) {}

    /// The material of a primitive, in the variant that is shown.
    const BoundMaterial& of(const Element& primitive);

  private:
    std::optional<size_t> indexFor(const Element& primitive) const;
    BoundMaterial readOrGrey(size_t index);
    BoundMaterial read(const Element& element);
    BoundMaterial standard();

    Context& context_;
    Textures textures_;
    std::map<std::optional<size_t>, BoundMaterial> made_;
};

/// The variants of KHR_materials_variants.
std::vector<std::string> variantNames(const Document& document);

/// The variant that `--variant` asks for; throws SceneError, with the names that there are, if
/// there is none of that name.
std::optional<size_t> chosenVariant(const Document& document, build::SceneBuilder& builder);

} // namespace stromboli::gltf
