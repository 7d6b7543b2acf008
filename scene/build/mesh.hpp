#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace stromboli::build {

/// Indices into Mesh::positions and Mesh::normals (kNoNormals where the file has no normal).
struct Corner {
    uint32_t position = 0, normal = 0;
};

using MeshTriangle = std::array<Corner, 3>;

/// The triangles of a mesh that share a material.
using MeshPart = std::vector<MeshTriangle>;

/// A mesh as the file states it, cut into triangles, in its own space.
struct Mesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals; ///< of any length; may be zero or not finite
    std::vector<MeshPart> parts;
};

} // namespace stromboli::build
