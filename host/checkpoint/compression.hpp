#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

/// Fewer bytes that say the same, made at some hundred megabytes a second.
std::vector<std::byte> compressed(std::span<const std::byte> bytes);

/// The `size` bytes that were compressed; nothing if they were others or another number.
std::optional<std::vector<std::byte>> decompressed(std::span<const std::byte> bytes, uint64_t size);

} // namespace stromboli
