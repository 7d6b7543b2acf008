#pragma once

#include "scene/gltf/element.hpp"

#include <string>
#include <string_view>

namespace stromboli::gltf {

/// The bytes of a bufferView that EXT_meshopt_compression packs: `extension` says how, `packed` are
/// the bytes that it names.
std::string unpackMeshopt(const Element& extension, std::string_view packed);

} // namespace stromboli::gltf
