// DirectDraw surfaces, in which games keep pictures ("DDS file layout" and "DXGI_FORMAT" of
// Microsoft's documents): a header of 128 bytes, or 148 where it names a format of Direct3D 10, and
// texels from the top, in blocks for GPUs or one by one. Smaller copies follow and are not read.

#include "scene/images/block_compression.hpp"
#include "scene/images/picture.hpp"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace stromboli::images {
namespace {

constexpr size_t kHeaderSize = 128, kLongHeaderSize = 148;
constexpr uint32_t kHasCode = 0x4, kIsLuminance = 0x20000, kIsSigned = 0x80000; ///< of the format
constexpr uint32_t kIsCube = 0x200, kIsVolume = 0x200000;

constexpr uint32_t code(const char (&text)[5]) {
    return uint32_t(uint8_t(text[0])) | uint32_t(uint8_t(text[1])) << 8 |
           uint32_t(uint8_t(text[2])) << 16 | uint32_t(uint8_t(text[3])) << 24;
}

/// Texels one by one: which bits of a whole number are which channel.
struct Masks {
    uint32_t bits = 0, red = 0, green = 0, blue = 0, alpha = 0;
};

/// Texels one by one, of `channels` numbers of 16 or 32 bits; a single one is grey.
struct Numbers {
    uint32_t channels = 0, bits = 0;
    bool areFloats = false;
};

struct Format {
    std::optional<BlockCompression> blocks{};
    Masks masks{};
    Numbers numbers{};
    bool isMultiplied = false; ///< colours by alpha
    bool isTwoAxes = false;    ///< red and green of a normal map, whose third number is left out
    bool isRedInAlpha = false; ///< of normal maps in BC3
};

Format blocksOf(BlockCompression kind) {
    Format format;
    format.blocks = kind;
    format.isTwoAxes = kind == BlockCompression::Bc5 || kind == BlockCompression::Bc5Signed;
    return format;
}

Format numbersOf(uint32_t channels, uint32_t bits, bool areFloats) {
    Format format;
    format.numbers = {channels, bits, areFloats};
    return format;
}

Format masksOf(const Masks& masks) {
    Format format;
    format.masks = masks;
    return format;
}

/// The formats of Direct3D 10 that pictures on surfaces have.
std::optional<Format> formatOfDxgi(uint32_t number) {
    using enum BlockCompression;
    switch (number) {
    case 2:
        return numbersOf(4, 32, true);
    case 6:
        return numbersOf(3, 32, true);
    case 10:
        return numbersOf(4, 16, true);
    case 11:
        return numbersOf(4, 16, false);
    case 28:
    case 29:
        return masksOf({32, 0xFF, 0xFF00, 0xFF0000, 0xFF000000});
    case 41:
        return numbersOf(1, 32, true);
    case 49: {
        Format format = masksOf({16, 0xFF, 0xFF00, 0, 0});
        format.isTwoAxes = true;
        return format;
    }
    case 54:
        return numbersOf(1, 16, true);
    case 56:
        return numbersOf(1, 16, false);
    case 61:
        return masksOf({8, 0xFF, 0xFF, 0xFF, 0});
    case 70:
    case 71:
    case 72:
        return blocksOf(Bc1);
    case 73:
    case 74:
    case 75:
        return blocksOf(Bc2);
    case 76:
    case 77:
    case 78:
        return blocksOf(Bc3);
    case 79:
    case 80:
        return blocksOf(Bc4);
    case 81:
        return blocksOf(Bc4Signed);
    case 82:
    case 83:
        return blocksOf(Bc5);
    case 84:
        return blocksOf(Bc5Signed);
    case 85:
        return masksOf({16, 0xF800, 0x7E0, 0x1F, 0});
    case 86:
        return masksOf({16, 0x7C00, 0x3E0, 0x1F, 0x8000});
    case 87:
    case 91:
        return masksOf({32, 0xFF0000, 0xFF00, 0xFF, 0xFF000000});
    case 88:
    case 93:
        return masksOf({32, 0xFF0000, 0xFF00, 0xFF, 0});
    case 97:
    case 98:
    case 99:
        return blocksOf(Bc7);
    default:
        return std::nullopt;
    }
}

/// What four letters, or a number of Direct3D 9 in their place, call a format.
std::optional<Format> formatOfCode(uint32_t number) {
    using enum BlockCompression;
    const auto variant = [](Format format, bool Format::*property) {
        format.*property = true;
        return format;
    };
    switch (number) {
    case code("DXT1"):
        return blocksOf(Bc1);
    case code("DXT2"):
        return variant(blocksOf(Bc2), &Format::isMultiplied);
    case code("DXT3"):
        return blocksOf(Bc2);
    case code("DXT4"):
        return variant(blocksOf(Bc3), &Format::isMultiplied);
    case code("DXT5"):
        return blocksOf(Bc3);
    case code("RXGB"):
        return variant(blocksOf(Bc3), &Format::isRedInAlpha);
    case code("ATI1"):
    case code("BC4U"):
        return blocksOf(Bc4);
    case code("BC4S"):
        return blocksOf(Bc4Signed);
    case code("ATI2"):
    case code("BC5U"):
        return blocksOf(Bc5);
    case code("BC5S"):
        return blocksOf(Bc5Signed);
    case 36:
        return numbersOf(4, 16, false);
    case 111:
        return numbersOf(1, 16, true);
    case 113:
        return numbersOf(4, 16, true);
    case 114:
        return numbersOf(1, 32, true);
    case 116:
        return numbersOf(4, 32, true);
    default:
        return std::nullopt;
    }
}

class DdsReader {
  public:
    DdsReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
        if (bytes_.size() < kHeaderSize) fail("the file is truncated");
        height_ = wordAt(12), width_ = wordAt(16);
    }

    Picture read() {
        const Format format = readFormat();
        if ((wordAt(112) & kIsCube) != 0) fail("it is a cube of six pictures");
        if ((wordAt(112) & kIsVolume) != 0) fail("it is a stack of pictures");
        const bool isDeep = format.numbers.channels > 0;
        requireSize(name_, width_, height_, isDeep ? 16 : 4, bytes_.size(), at_ + 1);
        Picture picture{width_, height_, {}};
        if (format.blocks)
            picture.values = readBlocks(*format.blocks);
        else if (!isDeep)
            picture.values = readMasked(format.masks);
        else if (format.numbers.areFloats)
            picture.values = readNumbers<float>(format.numbers);
        else
            picture.values = readNumbers<uint16_t>(format.numbers);
        if (auto* values = std::get_if<std::vector<uint8_t>>(&picture.values))
            applyMeaning(format, *values);
        if (isShort_) picture.addFault(build::Shortfall::PicturePart, "the file is truncated");
        return picture;
    }

  private:
    [[noreturn]] void fail(std::string_view problem) const { failToDecode(name_, "DDS", problem); }

    uint32_t wordAt(size_t i) const {
        uint32_t word = 0;
        for (size_t byte = 0; byte < 4; ++byte)
            word |= uint32_t(uint8_t(bytes_[i + byte])) << 8 * byte;
        return word;
    }

    Format readFormat() {
        const uint32_t flags = wordAt(80), named = wordAt(84);
        at_ = kHeaderSize;
        if ((flags & kHasCode) == 0) return readMasks(flags);
        if (named != code("DX10")) {
            const std::optional<Format> format = formatOfCode(named);
            if (!format)
                fail(named > 255 ? fmt::format("its format '{}' is not read", bytes_.substr(84, 4))
                                 : fmt::format("its format {} is not read", named));
            return *format;
        }
        if (bytes_.size() < kLongHeaderSize) fail("the file is truncated");
        at_ = kLongHeaderSize;
        std::optional<Format> format = formatOfDxgi(wordAt(128));
        if (!format) fail(fmt::format("its format, DXGI {}, is not read", wordAt(128)));
        constexpr uint32_t kCube = 4, kMultiplied = 2;
        if ((wordAt(136) & kCube) != 0) fail("it is a cube of six pictures");
        format->isMultiplied |= (wordAt(144) & 7) == kMultiplied;
        return *format;
    }

    Format readMasks(uint32_t flags) const {
        Masks masks{wordAt(88), wordAt(92), wordAt(96), wordAt(100), wordAt(104)};
        if (masks.bits == 0 || masks.bits > 32 || masks.bits % 8 != 0 || (flags & kIsSigned) != 0)
            fail("its texels are no colours");
        // Some programs leave out what the flag says.
        if ((flags & kIsLuminance) != 0) masks.green = masks.blue = masks.red;
        // Alpha alone.
        if ((masks.red | masks.green | masks.blue) == 0 && masks.alpha == 0)
            fail("its texels are no colours");
        return masksOf(masks);
    }

    /// The next bytes, or none and from then on none where the file ends.
    std::optional<std::span<const uint8_t>> next(size_t count) {
        if (isShort_ || bytes_.size() - at_ < count) {
            isShort_ = true;
            return std::nullopt;
        }
        const auto* from = reinterpret_cast<const uint8_t*>(bytes_.data()) + at_;
        at_ += count;
        return std::span(from, count);
    }

    /// Mid grey, which what is missing stays, as in pictures of other formats.
    template <class Value>
    std::vector<Value> blank(Value grey, Value opaque) const {
        std::vector<Value> values(size_t(width_) * height_ * 4, grey);
        for (size_t i = 3; i < values.size(); i += 4)
            values[i] = opaque;
        return values;
    }

    std::vector<uint8_t> readBlocks(BlockCompression kind) {
        std::vector<uint8_t> values = blank<uint8_t>(127, 255);
        for (uint32_t top = 0; top < height_; top += 4)
            for (uint32_t left = 0; left < width_; left += 4) {
                const auto bytes = next(blockSize(kind));
                if (!bytes) return values;
                const BlockTexels texels = decodeBlock(kind, *bytes);
                for (uint32_t y = top; y < std::min(top + 4, height_); ++y)
                    for (uint32_t x = left; x < std::min(left + 4, width_); ++x)
                        std::ranges::copy(texels[(y - top) * 4 + (x - left)],
                                          &values[(size_t(y) * width_ + x) * 4]);
            }
        return values;
    }

    std::vector<uint8_t> readMasked(const Masks& masks) {
        std::vector<uint8_t> values = blank<uint8_t>(127, 255);
        const auto channel = [](uint32_t word, uint32_t mask) {
            const uint64_t most = mask >> std::countr_zero(mask);
            const uint64_t value = (word & mask) >> std::countr_zero(mask);
            return uint8_t((value * 255 + most / 2) / most);
        };
        for (size_t i = 0; i < values.size(); i += 4) {
            const auto bytes = next(masks.bits / 8);
            if (!bytes) return values;
            uint32_t word = 0;
            for (size_t byte = 0; byte < bytes->size(); ++byte)
                word |= uint32_t((*bytes)[byte]) << 8 * byte;
            const uint32_t colors[] = {masks.red, masks.green, masks.blue};
            for (size_t c = 0; c < 3; ++c)
                values[i + c] = colors[c] ? channel(word, colors[c]) : 0;
            if (masks.alpha) values[i + 3] = channel(word, masks.alpha);
        }
        return values;
    }

    template <class Value>
    std::vector<Value> readNumbers(const Numbers& numbers) {
        const Value opaque = numbers.areFloats ? Value(1) : Value(65535);
        std::vector<Value> values = blank<Value>(Value(numbers.areFloats ? 0.5 : 32767), opaque);
        const size_t size = numbers.bits / 8;
        for (size_t i = 0; i < values.size(); i += 4) {
            const auto bytes = next(size * numbers.channels);
            if (!bytes) return values;
            for (size_t c = 0; c < 4; ++c) {
                if (c == 3 && numbers.channels < 4) break;
                const size_t from = numbers.channels == 1 ? 0 : c * size;
                values[i + c] = numberOf<Value>(bytes->subspan(from, size));
            }
        }
        return values;
    }

    template <class Value>
    static Value numberOf(std::span<const uint8_t> bytes) {
        uint32_t word = 0;
        for (size_t byte = 0; byte < bytes.size(); ++byte)
            word |= uint32_t(bytes[byte]) << 8 * byte;
        if constexpr (std::is_same_v<Value, uint16_t>) return uint16_t(word);
        return bytes.size() == 2 ? Value(glm::unpackHalf1x16(uint16_t(word)))
                                 : Value(std::bit_cast<float>(word));
    }

    /// What the channels of bytes are, other than colours and alpha.
    static void applyMeaning(const Format& format, std::vector<uint8_t>& values) {
        for (size_t i = 0; i < values.size(); i += 4) {
            uint8_t* const texel = &values[i];
            const double alpha = texel[3] / 255.0;
            if (format.isRedInAlpha) texel[0] = std::exchange(texel[3], uint8_t(255));
            if (format.isTwoAxes) {
                const double x = texel[0] / 127.5 - 1, y = texel[1] / 127.5 - 1;
                const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
                texel[2] = uint8_t(std::lround((z + 1) * 127.5));
            }
            if (format.isMultiplied && alpha > 0 && alpha < 1)
                for (size_t c = 0; c < 3; ++c)
                    texel[c] = uint8_t(std::min(std::lround(texel[c] / alpha), 255L));
        }
    }

    std::string_view bytes_;
    const std::string& name_;
    uint32_t width_ = 0, height_ = 0;
    size_t at_ = 0;
    bool isShort_ = false;
};

} // namespace

Picture decodeDds(std::string_view bytes, const std::string& name) {
    return DdsReader(bytes, name).read();
}

} // namespace stromboli::images
