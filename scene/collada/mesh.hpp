#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace stromboli::collada {

/// Indices into Mesh::positions and Mesh::normals (kNoNormals where the file has no normal).
struct Corner {
    uint32_t position = 0, normal = 0;
};

using MeshTriangle = std::array<Corner, 3>;

/// The triangles of one primitive element (<triangles>, <polylist>, ...).
struct PrimitiveGroup {
    std::string materialSymbol; ///< empty where the element names none
    std::vector<MeshTriangle> triangles;
};

/// A <mesh> as the file states it, cut into triangles, in the file's own space.
struct Mesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals; ///< of any length; may be zero or not finite
    std::vector<PrimitiveGroup> groups;
};

} // namespace stromboli::collada
