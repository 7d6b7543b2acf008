#pragma once

#include "scene/assimp/materials.hpp"
#include "scene/build/scene_builder.hpp"

#include <assimp/scene.h>

#include <optional>
#include <vector>

namespace stromboli::assimp {

/// The meshes of a file, each made when a node first shows it.
class Meshes {
  public:
    Meshes(const aiScene& scene, build::SceneBuilder& builder, Materials& materials);

    /// The shape of the mesh with this number; nothing if it has no triangles.
    std::optional<build::ShapeId> shapeOf(unsigned mesh);
    uint32_t materialOf(unsigned mesh);

  private:
    std::optional<build::ShapeId> make(const aiMesh& mesh);

    const aiScene& scene_;
    build::SceneBuilder& builder_;
    Materials& materials_;
    std::vector<std::optional<std::optional<build::ShapeId>>> shapes_; ///< empty: not made yet
};

} // namespace stromboli::assimp
