#pragma once

#include "host/film/film.hpp"
#include "host/film/image.hpp"
#include "host/film/tone_mapping.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

// --- Pictures and what is said of them -----------------------------------------------------------

/// What a picture's file says about the picture in words: text chunks of PNG, string attributes of
/// EXR, comments of JPEG, XMP of WebP.
struct PictureNote {
    std::string name; ///< 1 to 31 letters and digits of ASCII: PNG allows 79, EXR 31
    std::string text; ///< UTF-8 without NUL

    friend bool operator==(const PictureNote&, const PictureNote&) = default;
};
using PictureNotes = std::vector<PictureNote>;

// --- Picture files -------------------------------------------------------------------------------

struct PictureOptions {
    ToneMapping tone;        ///< not of EXR, which is linear
    bool statistics = false; ///< EXR only: also the channels "samples" (samples taken) and
                             ///< "variance.R", ".G", ".B" (variance of the mean)
    /// Others that place() is given: kAlphaChannel, and in EXR files any.
    std::vector<std::string> channels = {};
    PictureEncoding encoding = {}; ///< not of EXR

    bool hasAlpha() const {
        return std::find(channels.begin(), channels.end(), kAlphaChannel) != channels.end();
    }
};

/// A kind of file that pictures are written to.
enum class PictureFormat { Png, Exr, Jpeg, WebP };
/// That of a name, by its extension in any case of letters; "-" is a PNG on standard output. Throws
/// UsageError if the extension is none of a picture.
PictureFormat formatOf(const std::filesystem::path& path);

/// To be called before a long render. Throws UsageError (formatOf()), OutputError if no file can be
/// written there.
void checkWritable(const std::filesystem::path& path);

/// Whether a picture of that name is for a screen, and keeps no radiance.
bool isToneMapped(const std::filesystem::path& path);

/// Throws UsageError if a picture of that name cannot have so many pixels.
void checkPictureSize(const std::filesystem::path& path, uint32_t width, uint32_t height);

/// Whether a name ends as one of a picture does, in any case of letters.
bool namesPicture(const std::filesystem::path& path);

/// The most bytes that writePicture can make of so many pixels: what noise takes.
uint64_t largestPictureFile(const std::filesystem::path& path, uint32_t width, uint32_t height,
                            const PictureOptions& options, const PictureNotes& notes = {});

/// What the file of a picture says in words. Throws UsageError if it cannot be read.
PictureNotes readPictureNotes(const std::filesystem::path& path);

/// The film's means as bytes. alpha: the share of each pixel that is covered, by which means are
/// divided, as PNG has it; empty: all of it.
ByteImage toneMap(const Film& film, const ToneCurve& tone, std::span<const float> alpha = {});

/// The film's means in the channels R, G, B, and the statistics of PictureOptions if asked for.
FloatImage linearPicture(const Film& film, bool statistics);

/// A picture file in the making, put together from films of its parts.
class PictureFile {
  public:
    /// area: of all parts. Throws UsageError (extension).
    PictureFile(std::filesystem::path path, const PictureArea& area, const PictureOptions& options);
    /// Films of bands of whole rows of the area, and what else is known of their pixels: the
    /// channels of PictureOptions. What no film shows stays black.
    void place(const Film& film, const FloatImage& more = {});
    /// Writes the file, complete or not at all. An EXR file says where in the whole picture the
    /// area lies. `notes` are kept in it. Returns the tone mapping with what was found out from the
    /// picture. Throws OutputError.
    ToneMapping write(const PictureNotes& notes = {}) const;

  private:
    /// Whether films become bytes when they are placed. Everything else is made from what an EXR
    /// file holds, so that it can be made from one later, to the same bytes.
    bool mapsAtOnce() const;

    std::filesystem::path path_;
    PictureOptions options_;
    PictureArea area_;
    ByteImage bytes_;   ///< if it maps at once
    FloatImage floats_; ///< if it does not
};

/// Writes a picture for a screen, complete or not at all, and returns the tone mapping with what
/// was found out from the picture: channels R, G, B, and A if there is one. Throws OutputError.
ToneMapping writeToneMapped(const std::filesystem::path& path, const FloatImage& radiance,
                            const PictureOptions& options, const PictureNotes& notes = {});

/// Writes a picture file of a picture in one part.
void writePicture(const std::filesystem::path& path, const Film& film,
                  const PictureOptions& options);

} // namespace stromboli
