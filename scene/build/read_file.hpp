#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

namespace stromboli::build {

/// The bytes of a file, or its first `most` bytes. Throws SceneError if it cannot be read or is a
/// folder.
std::string readFile(const std::filesystem::path& file,
                     size_t most = std::numeric_limits<size_t>::max());

} // namespace stromboli::build
