#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace stromboli {

/// Writes `bytes` to `path` so that at every moment the file there is the old one (or none) or
/// the complete new one: the bytes go to a new file beside it, which then takes its name. A
/// symbolic link at `path` is followed. Throws OutputError, naming the file and the reason;
/// nothing new is left behind then.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Throws the OutputError that writeFileAtomically(path, ...) would throw, as far as that can be
/// known beforehand: it makes and removes an empty file beside `path`.
void checkFileWritable(const std::filesystem::path& path);

} // namespace stromboli
