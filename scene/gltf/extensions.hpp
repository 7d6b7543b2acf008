#pragma once

#include <string_view>

namespace stromboli::gltf {

/// True for extensions that are read, so that files may require them.
bool isReadExtension(std::string_view name);

} // namespace stromboli::gltf
