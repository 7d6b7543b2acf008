#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace stromboli {

/// Where a command writes: a file, or standard output where the name is "-".
bool isStandardOutput(const std::filesystem::path& path);

/// As writeFileAtomically, or all of it to standard output. Throws OutputError.
void writeOutput(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeOutput(const std::filesystem::path& path, std::string_view text);

/// As checkFileWritable; of standard output nothing is known beforehand.
void checkOutputWritable(const std::filesystem::path& path);

/// To be called before anything is opened: a standard stream that was closed when the program was
/// started would give its number to the next file that is opened, and what is printed would end up
/// there. Writing to a closed standard output fails.
void reserveStandardStreams();

/// Throws OutputError if something that was printed could not be written. To be called at the end:
/// what is printed waits in a buffer.
void finishStandardOutput();

} // namespace stromboli
