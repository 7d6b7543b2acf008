#pragma once

#include "scene/gltf/accessors.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace stromboli::gltf {

/// What KHR_draco_mesh_compression packs of a primitive.
struct UnpackedPrimitive {
    std::vector<uint32_t> indices;
    std::map<std::string, Values> attributes; ///< by their names, such as POSITION
};

/// `extension`: of `primitive`. Attributes are read with the types that their accessors state.
/// Throws SceneError if the data are damaged.
UnpackedPrimitive unpackDraco(const Document& document, const Element& primitive,
                              const Element& extension);

} // namespace stromboli::gltf
