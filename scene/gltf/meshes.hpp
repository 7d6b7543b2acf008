#pragma once

#include "scene/gltf/materials.hpp"
#include "scene/gltf/primitives.hpp"

#include <map>
#include <optional>
#include <vector>

namespace stromboli::gltf {

/// A mesh that the builder has, and the material of each of its parts.
struct BuiltMesh {
    build::ShapeId shape{};
    std::vector<uint32_t> materials;
};

/// What changes the shape of a mesh where a node shows it.
struct Deformation {
    std::vector<double> weights;    ///< of morph targets; empty: those of the mesh
    std::vector<glm::dmat4> joints; ///< of the node's skin, to world; empty: it has none

    bool isNone() const { return weights.empty() && joints.empty(); }
};

/// Hands meshes to the builder: those that nodes do not deform once, whatever shows them.
class Meshes {
  public:
    explicit Meshes(Context& context) : context_(context), materials_(context) {}

    /// Nothing if the mesh has nothing to show.
    std::optional<BuiltMesh> get(size_t mesh, const Deformation& deformation);

  private:
    std::optional<BuiltMesh> make(const Element& element, const Deformation& deformation);
    /// Returns the part's material, which may be another one than that of its element.
    uint32_t append(const Element& element, Primitive&& primitive, const BoundMaterial& material,
                    build::Mesh& mesh);
    uint32_t withColors(Material unlit, build::Mesh& mesh, build::MeshPart& part);

    Context& context_;
    Materials materials_;
    std::map<size_t, std::optional<BuiltMesh>> made_;
};

} // namespace stromboli::gltf
