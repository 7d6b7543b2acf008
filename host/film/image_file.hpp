#pragma once

#include "host/film/film.hpp"
#include "host/film/image.hpp"
#include "host/film/tone.hpp"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

/// The channel of the share of a pixel that is covered.
inline constexpr const char* kAlphaChannel = "A";

struct PictureOptions {
    ToneCurve tone;          ///< PNG only; an EXR file is linear
    bool statistics = false; ///< EXR only: also the channels "samples" (samples taken) and
                             ///< "variance.R", ".G", ".B" (variance of the mean)
    /// Others that place() is given: kAlphaChannel, and in EXR files any.
    std::vector<std::string> channels = {};

    bool hasAlpha() const {
        return std::find(channels.begin(), channels.end(), kAlphaChannel) != channels.end();
    }
};

/// To be called before a long render. Throws UsageError if the extension is neither .png nor
/// .exr (in any case of letters), OutputError if no file can be written there. "-" is a PNG on
/// standard output.
void checkWritable(const std::filesystem::path& path);

/// Whether a picture of that name keeps 8 bits of a radiance.
bool isPng(const std::filesystem::path& path);

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
    /// As PNG or EXR, by the extension, complete or not at all. An EXR file says where in the whole
    /// picture the area lies. `notes` are kept in it. Throws OutputError.
    void write(const PictureNotes& notes = {}) const;

  private:
    std::filesystem::path path_;
    PictureOptions options_;
    PictureArea area_;
    ByteImage bytes_;   ///< PNG
    FloatImage floats_; ///< EXR
};

/// The same of a picture in one part.
void writePicture(const std::filesystem::path& path, const Film& film,
                  const PictureOptions& options);

} // namespace stromboli
