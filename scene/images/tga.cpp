// Truevision TGA ("Truevision TGA File Format Specification", version 2.0, 1991): a header of 18
// bytes, a name, a table of colours, and pixels, row after row or as runs of equal ones.

#include "scene/images/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace stromboli::images {
namespace {

constexpr size_t kHeaderSize = 18;
enum Kind : uint8_t { kMapped = 1, kColor = 2, kGrey = 3 };
constexpr uint8_t kRuns = 8; ///< added to the kind where pixels are packed

struct Header {
    uint8_t nameLength = 0, hasTable = 0, kind = 0;
    bool packed = false;
    uint32_t tableFirst = 0, tableLength = 0, tableBits = 0;
    uint32_t width = 0, height = 0, bits = 0;
    bool hasAlpha = false, rightToLeft = false, topDown = false;
};

uint8_t byteAt(std::string_view bytes, size_t i) {
    return uint8_t(bytes[i]);
}

uint32_t shortAt(std::string_view bytes, size_t i) {
    return uint32_t(byteAt(bytes, i)) | uint32_t(byteAt(bytes, i + 1)) << 8;
}

Header headerOf(std::string_view bytes) {
    Header h;
    h.nameLength = byteAt(bytes, 0);
    h.hasTable = byteAt(bytes, 1);
    h.kind = uint8_t(byteAt(bytes, 2) & ~kRuns);
    h.packed = (byteAt(bytes, 2) & kRuns) != 0;
    h.tableFirst = shortAt(bytes, 3), h.tableLength = shortAt(bytes, 5);
    h.tableBits = byteAt(bytes, 7);
    h.width = shortAt(bytes, 12), h.height = shortAt(bytes, 14);
    h.bits = byteAt(bytes, 16);
    const uint8_t descriptor = byteAt(bytes, 17);
    h.hasAlpha = (descriptor & 15) != 0;
    h.rightToLeft = (descriptor & 16) != 0, h.topDown = (descriptor & 32) != 0;
    return h;
}

bool isColorDepth(uint32_t bits) {
    return bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

using Texel = std::array<uint8_t, 4>;

/// A colour as the file has it: blue first, or five bits of each in two bytes.
Texel colorAt(std::string_view bytes, size_t at, uint32_t bits, bool hasAlpha) {
    if (bits >= 24) {
        const uint8_t alpha = bits == 32 && hasAlpha ? byteAt(bytes, at + 3) : uint8_t(255);
        return {byteAt(bytes, at + 2), byteAt(bytes, at + 1), byteAt(bytes, at), alpha};
    }
    const uint32_t word = shortAt(bytes, at);
    const auto five = [&](uint32_t shift) {
        return uint8_t(((word >> shift & 31) * 255 + 15) / 31);
    };
    const bool transparent = bits == 16 && hasAlpha && (word & 0x8000) == 0;
    return {five(10), five(5), five(0), transparent ? uint8_t(0) : uint8_t(255)};
}

class Decoder {
  public:
    Decoder(std::string_view bytes, const std::string& name)
        : bytes_(bytes), name_(name), h_(headerOf(bytes)) {
        table_ = kHeaderSize + h_.nameLength;
        at_ = table_ + size_t(h_.hasTable ? h_.tableLength : 0) * ((h_.tableBits + 7) / 8);
    }

    Picture read() {
        const uint64_t pixelBytes = (h_.bits + 7) / 8;
        const uint64_t count = uint64_t(h_.width) * h_.height;
        // A packet of a run has one byte and a pixel, and stands for 128 pixels at most.
        const uint64_t least =
            h_.packed ? (count + 127) / 128 * (1 + pixelBytes) : count * pixelBytes;
        // A part of the pixels is shown, but not next to nothing of a picture of any size.
        constexpr uint64_t leastPart = 256;
        requireSize(name_, h_.width, h_.height, 4, bytes_.size(), at_ + least / leastPart + 1);
        std::vector<uint8_t> values(size_t(count) * 4, 127); // of what is missing: mid grey
        for (size_t i = 3; i < values.size(); i += 4)
            values[i] = 255;
        uint32_t run = 0;
        bool repeats = false;
        Texel texel{};
        for (size_t i = 0; i < count; ++i) {
            if (h_.packed && run == 0) {
                if (!isThere(1)) return partOf(std::move(values));
                const uint8_t packet = byteAt(bytes_, at_++);
                run = (packet & 127u) + 1u;
                repeats = (packet & 128) != 0;
                if (repeats && !next(texel)) return partOf(std::move(values));
            }
            if (!repeats && !next(texel)) return partOf(std::move(values));
            if (h_.packed) --run;
            const size_t x = i % h_.width, y = i / h_.width;
            const size_t column = h_.rightToLeft ? h_.width - 1 - x : x;
            const size_t row = h_.topDown ? y : h_.height - 1 - y;
            std::copy(texel.begin(), texel.end(), &values[(row * h_.width + column) * 4]);
        }
        return {h_.width, h_.height, std::move(values)};
    }

  private:
    bool isThere(size_t count) const { return bytes_.size() - at_ >= count; }

    Picture partOf(std::vector<uint8_t> values) const {
        Picture picture{h_.width, h_.height, std::move(values)};
        picture.addFault(build::Shortfall::PicturePart, "the file is truncated");
        return picture;
    }

    /// False where the file has ended.
    bool next(Texel& texel) {
        const size_t size = (h_.bits + 7) / 8;
        if (!isThere(size)) return false;
        texel = colorOf(at_);
        at_ += size;
        return true;
    }

    Texel colorOf(size_t at) const {
        if (h_.kind == kColor) return colorAt(bytes_, at, h_.bits, h_.hasAlpha);
        const uint8_t value = byteAt(bytes_, at);
        if (h_.kind == kGrey) return {value, value, value, 255};
        const uint32_t entry = value - h_.tableFirst; // of a value before the first one: too large
        if (entry >= h_.tableLength)
            failToDecode(
                name_, "TGA",
                fmt::format("a pixel has the colour {}, of a table of {}", value, h_.tableLength));
        return colorAt(bytes_, table_ + size_t(entry) * ((h_.tableBits + 7) / 8), h_.tableBits,
                       h_.hasAlpha);
    }

    std::string_view bytes_;
    const std::string& name_;
    Header h_;
    size_t table_ = 0, at_ = 0;
};

} // namespace

bool looksLikeTga(std::string_view bytes) {
    if (bytes.size() < kHeaderSize) return false;
    const Header h = headerOf(bytes);
    if (h.hasTable > 1 || (byteAt(bytes, 17) & 0xC0) != 0 || h.width == 0 || h.height == 0)
        return false;
    if (h.kind == kMapped) return h.hasTable == 1 && h.bits == 8 && isColorDepth(h.tableBits);
    return (h.kind == kColor && isColorDepth(h.bits)) || (h.kind == kGrey && h.bits == 8);
}

Picture decodeTga(std::string_view bytes, const std::string& name) {
    return Decoder(bytes, name).read();
}

} // namespace stromboli::images
