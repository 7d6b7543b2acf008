#pragma once

#include "scene/gltf/accessors.hpp"
#include "scene/gltf/context.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::gltf {

/// The geometry of a primitive, in the mesh's space.
struct Primitive {
    std::vector<std::array<uint32_t, 3>> triangles; ///< into the vertices
    size_t vertexCount = 0;
    Values positions;
    std::optional<Values> normals, tangents, colors; ///< of 3, 4, and 3 or 4 numbers
    std::array<std::optional<Values>, 2> uvs;        ///< of the two sets that were asked for
    std::vector<Values> joints, weights;             ///< of 4 numbers, for each JOINTS_n
    /// Displacements of morph targets; empty where a target states none.
    struct Target {
        std::optional<Values> positions, normals, tangents, colors;
        std::array<std::optional<Values>, 2> uvs; ///< of the sets that were asked for
    };
    std::vector<Target> targets;
};

/// Reads a primitive; nothing if it has no triangles to show. `uvSets`: which TEXCOORD_n are read.
std::optional<Primitive> readPrimitive(Context& context, const Element& element,
                                       const std::array<uint32_t, 2>& uvSets);

} // namespace stromboli::gltf
