#pragma once

#include "scene/build/shortfall.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace stromboli::images {

/// More columns or rows than this are refused: a file of a few bytes can claim any size. Of
/// Radiance pictures four times as many become means of blocks, as they are read.
inline constexpr uint32_t kLargestSide = 16384;

/// What is wrong with a picture that is shown all the same.
struct PictureFault {
    build::Shortfall kind = build::Shortfall::PicturePart;
    std::string problem;
};

/// A picture as its file states it: red, green, blue and alpha of each pixel, row after row from
/// the top. Grey pictures have three equal colours; without alpha in the file, it is 1.
struct Picture {
    uint32_t width = 0, height = 0;
    /// Fractions of 255 or of 65535, with the file's transfer function (sRGB for colours), or
    /// linear light as floats.
    std::variant<std::vector<uint8_t>, std::vector<uint16_t>, std::vector<float>> values;
    std::vector<PictureFault> faults{};

    size_t texelCount() const { return size_t(width) * height; }
    void addFault(build::Shortfall kind, const std::string& problem) {
        faults.emplace_back().kind = kind;
        faults.back().problem = problem;
    }
};

/// Decodes the bytes of a PNG, JPEG, WebP, GIF, BMP, TIFF, DDS, Radiance HDR, OpenEXR, PFM or TGA
/// file, told by their beginning. `name` is what messages call it. Throws SceneError if the bytes
/// are none of these, damaged beyond use, if a side exceeds kLargestSide, if they are too few for
/// the size that they claim, or if the pixels would not fit in the machine's memory. Radiance
/// pictures of more than `largestSide` are shrunk while they are read.
Picture decodePicture(std::string_view bytes, const std::string& name,
                      uint32_t largestSide = kLargestSide);

/// The decoders, one for each format.
Picture decodePng(std::string_view bytes, const std::string& name);
Picture decodeJpeg(std::string_view bytes, const std::string& name);
Picture decodeWebp(std::string_view bytes, const std::string& name);
Picture decodeGif(std::string_view bytes, const std::string& name);
Picture decodeHdr(std::string_view bytes, const std::string& name, uint32_t largestSide);
Picture decodeExr(std::string_view bytes, const std::string& name);
Picture decodeBmp(std::string_view bytes, const std::string& name);
Picture decodeTga(std::string_view bytes, const std::string& name);
Picture decodeTiff(std::string_view bytes, const std::string& name);
Picture decodeDds(std::string_view bytes, const std::string& name);
Picture decodePfm(std::string_view bytes, const std::string& name);

/// True if a file that begins like this is OpenEXR.
bool isExr(std::string_view bytes);

/// A picture that may be a part of a larger one.
struct PicturePart {
    Picture picture;
    uint32_t left = 0, top = 0;     ///< of the part in the whole
    uint32_t width = 0, height = 0; ///< of the whole
};

/// A layer of an OpenEXR file, as it is stored: its data window alone, and not turned or unfolded
/// if the header calls it an environment. `layer`: a layer's name, as of exrChannelsOf(), or that
/// of a part with channels without a layer; empty: the likeliest picture. Throws SceneError.
PicturePart decodeExrLayer(std::string_view bytes, const std::string& name,
                           const std::string& layer);

/// True if a file that begins like this can be a TGA: the format has no mark of its own, but few
/// other files have a header that makes sense as one.
bool looksLikeTga(std::string_view bytes);

/// Throws SceneError unless a picture of this size may be decoded: its sides lie within
/// [1, kLargestSide], the machine can hold its pixels, and at least `leastBytes` of the file's
/// `fileBytes` are there, below which no file of the format can describe so many pixels.
/// In this order: the sides, the bytes, all of it and the memory.
void requireSides(const std::string& name, uint64_t width, uint64_t height, uint64_t largest);
void requireBytes(const std::string& name, uint64_t width, uint64_t height, uint64_t fileBytes,
                  uint64_t leastBytes);
void requireSize(const std::string& name, uint64_t width, uint64_t height, uint64_t bytesPerTexel,
                 uint64_t fileBytes, uint64_t leastBytes);

[[noreturn]] void failToDecode(const std::string& name, std::string_view format,
                               std::string_view problem);

} // namespace stromboli::images
