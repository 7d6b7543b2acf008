#pragma once

#include "host/film/image_file.hpp"

#include <filesystem>

namespace stromboli {

// --- PNG -----------------------------------------------------------------------------------------

/// What a PNG says about its colours.
enum class PngColorSpace {
    Srgb,    ///< an sRGB chunk
    Unnamed, ///< nothing
};

/// Writes an RGB PNG of 8 or of 16 bits a channel, complete or not at all. Throws OutputError.
void writePng(const std::filesystem::path& path, const ByteImage& image, PngColorSpace colorSpace,
              const PictureNotes& notes = {});
void writePng(const std::filesystem::path& path, const WordImage& image, PngColorSpace colorSpace,
              const PictureNotes& notes = {});

/// Reads any PNG as 8-bit RGB: palettes and greys are expanded, 16 bits are scaled down, alpha
/// is dropped, no colour conversion is made. Throws UsageError if there is no readable PNG.
ByteImage readPng(const std::filesystem::path& path);

/// The texts of a PNG, in the file's order. Throws UsageError if there is no readable PNG.
PictureNotes readPngNotes(const std::filesystem::path& path);

// --- JPEG and WebP -------------------------------------------------------------------------------

// Pictures of 8 bits a channel are sRGB, which programs take them for where they say nothing.

inline constexpr uint32_t kLargestJpegSide = 65500, kLargestWebPSide = 16383;

/// Writes a JPEG with colours for each pixel (4:4:4), complete or not at all; its alpha is left
/// out. quality: 1 to 100, as libjpeg scales its tables. Each note is a comment, "name: text", of
/// at most 65533 bytes. Throws OutputError.
void writeJpeg(const std::filesystem::path& path, const ByteImage& image, uint32_t quality,
               const PictureNotes& notes = {});

/// The comments that writeJpeg() makes of notes, in the file's order. Throws UsageError if there is
/// no readable JPEG.
PictureNotes readJpegNotes(const std::filesystem::path& path);

/// Writes a WebP, complete or not at all. quality: 1 to 99 with loss, 100 without any. The notes
/// are in its XMP. Throws OutputError.
void writeWebP(const std::filesystem::path& path, const ByteImage& image, uint32_t quality,
               const PictureNotes& notes = {});

/// The notes that writeWebP() puts there, in the file's order. Throws UsageError if there is no
/// readable WebP.
PictureNotes readWebPNotes(const std::filesystem::path& path);

// --- OpenEXR -------------------------------------------------------------------------------------

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

// --- PFM -----------------------------------------------------------------------------------------

/// Reads a Portable Float Map (Debevec 1998): "PF" as channels R, G, B; "Pf" (grey) as three equal
/// ones. Either byte order. The scale, whose sign is the byte order, is otherwise ignored, as
/// nearly all programs do. Throws UsageError if there is no readable file.
FloatImage readPfm(const std::filesystem::path& path);

/// Writes channels R, G, B in little-endian order, complete or not at all. Throws OutputError.
void writePfm(const std::filesystem::path& path, const FloatImage& image);

} // namespace stromboli
