#pragma once

#include "scene/build/conventions.hpp"
#include "scene/build/mesh.hpp"
#include "scene/model/material.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace stromboli::build {

/// More triangles than this do not fit in the scene's 32-bit corner numbers with room to spare.
inline constexpr size_t kMostTriangles = size_t(1) << 28;

size_t triangleCount(const Mesh& mesh);

/// A mesh somewhere in the world.
struct MeshUse {
    size_t shape = 0; ///< number of the mesh
    glm::dmat4 toWorld{1.0};
    std::vector<uint32_t> materials; ///< of its parts
    uint32_t instance = 0;           ///< into Scene::instances
};

/// Decides which uses of meshes get copies of their triangles, and which share them.
class MeshUses {
  public:
    /// Uses that share the triangles of one prototype, in the order of the file.
    struct Shared {
        std::vector<size_t> uses;
    };

    /// All are copies. `uses` and what `meshOf` gives must outlive the object.
    MeshUses(std::span<const MeshUse> uses, std::function<const Mesh&(size_t)> meshOf);

    /// Lets uses share triangles where the sharing asked for has it, the same mesh has the same
    /// materials, none of them emits (each emitter is a light of its own), and the matrix is fit
    /// for it.
    void share(std::span<const Material> materials, InstanceSharing sharing);

    const std::vector<Shared>& shared() const { return shared_; }
    const std::vector<size_t>& copied() const { return copied_; }
    uint64_t copiedTriangles() const;

  private:
    std::vector<Shared> candidates(std::span<const Material> materials) const;

    std::span<const MeshUse> uses_;
    std::function<const Mesh&(size_t)> meshOf_;
    std::vector<Shared> shared_;
    std::vector<size_t> copied_;
};

} // namespace stromboli::build
