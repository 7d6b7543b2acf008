#pragma once

#include <cstdint>
#include <filesystem>

namespace stromboli {

/// CRC-32 of a file's bytes; of no bytes if it cannot be read.
uint32_t checksumOfFile(const std::filesystem::path& file);

} // namespace stromboli
