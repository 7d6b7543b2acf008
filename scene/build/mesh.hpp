#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace stromboli::build {

/// Indices into Mesh::positions, Mesh::normals (kNoNormals where the file has no normal) and
/// Mesh::attributes (kNoAttributes where it has none).
struct Corner {
    uint32_t position = 0, normal = 0;
    uint32_t attributes = kNoAttributes;
};

using MeshTriangle = std::array<Corner, 3>;

/// The triangles of a mesh that share a material.
using MeshPart = std::vector<MeshTriangle>;

/// A mesh as the file states it, cut into triangles, in its own space.
struct Mesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals; ///< of any length; may be zero or not finite
    bool isFlat = false;             ///< without normals, it is meant to be shaded flat
    /// Tangents in the mesh's space, of any length; those without direction are left out. The
    /// other numbers must be finite.
    std::vector<VertexAttributes> attributes;
    std::vector<MeshPart> parts;
};

} // namespace stromboli::build
