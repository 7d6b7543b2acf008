#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace stromboli {

/// When the bytes of a file are on the disk, and not only in the system's memory.
enum class Sync {
    Now,  ///< before the file gets its name: no full disk is found out later, no power cut hurts
    Later ///< whenever the system likes: for files that are checked when they are read
};

/// Writes `bytes` to `path` so that at every moment the file there is the old one (or none) or
/// the complete new one: the bytes go to a new file beside it, which then takes its name. A
/// symbolic link at `path` is followed. Throws OutputError, naming the file and the reason;
/// nothing new is left behind then.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes,
                         Sync sync = Sync::Now);

/// Throws the OutputError that writeFileAtomically(path, ...) would throw, as far as that can be
/// known beforehand: it makes and removes an empty file beside `path`.
void checkFileWritable(const std::filesystem::path& path);

/// Throws OutputError if the file system that `path` is on has not so many bytes free.
void checkFreeSpace(const std::filesystem::path& path, uint64_t bytes);

} // namespace stromboli
