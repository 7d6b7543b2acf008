#pragma once

#include "host/film/film.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

// --- Tone curves ---------------------------------------------------------------------------------

/// How linear radiance becomes a byte of a picture. Each channel by itself; values above the
/// range are clamped.
struct ToneCurve {
    enum class Kind {
        Srgb,  ///< IEC 61966-2-1 transfer curve, rounded to the nearest byte
        Cs184, ///< floor(255 min(1, (sqrt(2) L)^(1 / 2.2))): the CS184 renderer's curve
    };

    Kind kind = Kind::Srgb;
    double exposure = 0; ///< stops: radiance is multiplied by 2^exposure first

    /// The byte for a radiance; 0 for NaN and for negative values.
    uint8_t toByte(double radiance) const;
};

/// The sRGB transfer curve: linear light in [0, 1] to signal in [0, 1]; clamps its argument.
double srgbFromLinear(double linear);

/// Inverse of srgbFromLinear: signal in [0, 1] to linear light; clamps its argument.
double linearFromSrgb(double signal);

/// The radiance in the middle of the interval that Cs184 (exposure 0) maps to `byte`, on the
/// signal axis: ((byte + 1/2) / 255)^2.2 / sqrt(2).
double radianceFromCs184(uint8_t byte);

// --- Images in memory ----------------------------------------------------------------------------

/// What a picture's file says about the picture in words: text chunks of PNG, string attributes of
/// EXR.
struct PictureNote {
    std::string name; ///< 1 to 31 letters and digits of ASCII: PNG allows 79, EXR 31
    std::string text; ///< UTF-8 without NUL

    friend bool operator==(const PictureNote&, const PictureNote&) = default;
};
using PictureNotes = std::vector<PictureNote>;

/// 8-bit picture: rows from the top, three bytes (R, G, B) per pixel.
struct ByteImage {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
    /// One byte per pixel, by which rgb is not multiplied; empty: all is opaque.
    std::vector<uint8_t> alpha;

    ByteImage() = default;
    ByteImage(uint32_t w, uint32_t h) : width(w), height(h), rgb(size_t(w) * h * 3) {}
    uint8_t* pixel(uint32_t x, uint32_t y) { return &rgb[(size_t(y) * width + x) * 3]; }
    const uint8_t* pixel(uint32_t x, uint32_t y) const { return &rgb[(size_t(y) * width + x) * 3]; }
};

/// Linear picture, or a part of one: named channels ("R", "G", "B", ...), each with width * height
/// values, rows from the top.
struct FloatImage {
    uint32_t width = 0, height = 0; ///< of the part
    PictureArea area;               ///< where the part lies in the whole picture
    std::map<std::string, std::vector<float>> channels;
    uint32_t branches = 1; ///< paths of each sample that the channel "samples" counts by paths

    FloatImage() = default;
    explicit FloatImage(const PictureArea& a)
        : width(a.rendered().width), height(a.rendered().height), area(a) {}
    FloatImage(uint32_t w, uint32_t h) : FloatImage(PictureArea{w, h, {}}) {}
    /// The channel of that name, made (all 0) if there is none.
    std::vector<float>& channel(const std::string& name);
};

// --- Picture files -------------------------------------------------------------------------------

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
    /// Writes PNG or EXR, by the extension, complete or not at all. An EXR file says where in the
    /// whole picture the area lies. `notes` are kept in it. Throws OutputError.
    void write(const PictureNotes& notes = {}) const;

  private:
    std::filesystem::path path_;
    PictureOptions options_;
    PictureArea area_;
    ByteImage bytes_;   ///< PNG
    FloatImage floats_; ///< EXR
};

/// Writes a picture file of a picture in one part.
void writePicture(const std::filesystem::path& path, const Film& film,
                  const PictureOptions& options);

} // namespace stromboli
