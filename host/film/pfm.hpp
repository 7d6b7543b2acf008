#pragma once

#include "host/film/image.hpp"

#include <filesystem>

namespace stromboli {

/// Reads a Portable Float Map (Debevec 1998): "PF" as channels R, G, B; "Pf" (grey) as three equal
/// ones. Either byte order. The scale, whose sign is the byte order, is otherwise ignored, as
/// nearly all programs do. Throws UsageError if there is no readable file.
FloatImage readPfm(const std::filesystem::path& path);

/// Writes channels R, G, B in little-endian order, complete or not at all. Throws OutputError.
void writePfm(const std::filesystem::path& path, const FloatImage& image);

} // namespace stromboli
