#pragma once

#include "host/film/image.hpp"

#include <filesystem>

namespace stromboli {

/// Writes every channel as 32-bit float (lossless ZIP), complete or not at all. The display window
/// is the whole picture, the data window the part of it that there is. An attribute "branches" says
/// how many paths a sample has, if more than one. Throws OutputError.
void writeExr(const std::filesystem::path& path, const FloatImage& image,
              const PictureNotes& notes = {});

/// Reads every channel of a scan-line or tiled OpenEXR file of one part, its data window only.
/// Half and integer channels become float. Throws UsageError if there is no readable file.
FloatImage readExr(const std::filesystem::path& path);

/// The string attributes of an OpenEXR file, by name. Throws UsageError if there is no readable
/// file.
PictureNotes readExrNotes(const std::filesystem::path& path);

} // namespace stromboli
