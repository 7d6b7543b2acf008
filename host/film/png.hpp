#pragma once

#include "host/film/image.hpp"

#include <filesystem>

namespace stromboli {

/// What a PNG says about its colours.
enum class PngColorSpace {
    Srgb,    ///< an sRGB chunk
    Unnamed, ///< nothing
};

/// Writes an 8-bit RGB PNG, complete or not at all. Throws OutputError.
void writePng(const std::filesystem::path& path, const ByteImage& image, PngColorSpace colorSpace,
              const PictureNotes& notes = {});

/// Reads any PNG as 8-bit RGB: palettes and greys are expanded, 16 bits are scaled down, alpha
/// is dropped, no colour conversion is made. Throws UsageError if there is no readable PNG.
ByteImage readPng(const std::filesystem::path& path);

/// The texts of a PNG, in the file's order. Throws UsageError if there is no readable PNG.
PictureNotes readPngNotes(const std::filesystem::path& path);

} // namespace stromboli
