#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace stromboli::build {

/// The bytes of a file, or its first `most` bytes. Throws SceneError if it cannot be read, is
/// larger than the machine's memory, or is no regular file: folders, devices and pipes are refused
/// at once, and so is what stands in for a file that has not been fetched.
std::string readFile(const std::filesystem::path& file,
                     size_t most = std::numeric_limits<size_t>::max());

/// Throws SceneError if reading `file` takes so many bytes of memory that the machine cannot have
/// them.
void requireMemory(const std::string& file, uint64_t bytes);

} // namespace stromboli::build
