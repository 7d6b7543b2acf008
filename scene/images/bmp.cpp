// Windows bitmaps (Microsoft, "Bitmap Storage"): a file header of 14 bytes, one about the picture,
// a table of colours, and rows of pixels from the bottom, each filled up to four bytes. Of those
// that are packed, runs of bytes are read.

#include "scene/images/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

namespace stromboli::images {
namespace {

constexpr size_t kFileHeader = 14, kLeastInfo = 40;

uint32_t bytesAt(std::string_view bytes, size_t at, size_t count) {
    uint32_t value = 0;
    for (size_t i = 0; i < count; ++i)
        value |= uint32_t(uint8_t(bytes[at + i])) << 8 * i;
    return value;
}

struct Header {
    uint32_t pixelsAt = 0, infoSize = 0, bits = 0, packing = 0, colors = 0;
    int64_t width = 0, height = 0; ///< a height below 0: rows from the top
};

Header headerOf(std::string_view bytes) {
    Header h;
    h.pixelsAt = bytesAt(bytes, 10, 4);
    h.infoSize = bytesAt(bytes, 14, 4);
    h.width = int32_t(bytesAt(bytes, 18, 4));
    h.height = int32_t(bytesAt(bytes, 22, 4));
    h.bits = bytesAt(bytes, 28, 2);
    h.packing = bytesAt(bytes, 30, 4);
    h.colors = bytesAt(bytes, 46, 4);
    return h;
}

/// Where a colour of pixels of 16 bits lies in them.
struct Mask {
    uint32_t bits = 0;

    uint8_t of(uint32_t pixel) const {
        const int shift = std::countr_zero(bits);
        const uint32_t most = bits == 0 ? 1 : bits >> shift;
        const uint32_t value = bits == 0 ? 0 : (pixel & bits) >> shift;
        return uint8_t((value * 255u + most / 2) / most);
    }
};

/// Red, green, blue: five bits each, or what stands behind the header or in its later part.
std::array<Mask, 3> masksOf(std::string_view bytes, const Header& h) {
    constexpr uint32_t kStated = 3;
    if (h.packing != kStated) return {Mask{0x7C00}, Mask{0x03E0}, Mask{0x001F}};
    std::array<Mask, 3> masks;
    for (size_t i = 0; i < masks.size(); ++i)
        masks[i].bits = bytesAt(bytes, kFileHeader + kLeastInfo + 4 * i, 4) & 0xFFFF;
    return masks;
}

/// Pixels in runs: a count and a colour, or a zero and what comes next: an end of line (0), the end
/// (1), a step to the right and up (2), or a number of pixels one by one, filled up to two bytes.
/// The result is as if they had not been packed; pixels that are left out have colour 0.
std::string unpacked(std::string_view runs, uint64_t width, uint64_t height) {
    const uint64_t rowBytes = (width + 3) / 4 * 4;
    std::string pixels(rowBytes * height, '\0');
    uint64_t x = 0, y = 0;
    const auto put = [&](char color) {
        if (x < width && y < height) pixels[y * rowBytes + x] = color;
        ++x;
    };
    for (size_t at = 0; at + 2 <= runs.size();) {
        const auto count = uint8_t(runs[at]), what = uint8_t(runs[at + 1]);
        at += 2;
        if (count > 0) {
            for (int i = 0; i < count; ++i)
                put(char(what));
        } else if (what == 0) {
            x = 0;
            ++y;
        } else if (what == 1) {
            break;
        } else if (what == 2) {
            if (at + 2 > runs.size()) break;
            x += uint8_t(runs[at]);
            y += uint8_t(runs[at + 1]);
            at += 2;
        } else {
            for (size_t i = 0; i < what && at + i < runs.size(); ++i)
                put(runs[at + i]);
            at += (what + 1u) / 2 * 2;
        }
    }
    return pixels;
}

} // namespace

Picture decodeBmp(std::string_view bytes, const std::string& name) {
    const auto fail = [&](const std::string& problem) { failToDecode(name, "BMP", problem); };
    if (bytes.size() < kFileHeader + kLeastInfo) fail("the header is truncated");
    const Header h = headerOf(bytes);
    if (h.infoSize < kLeastInfo) fail("it is of OS/2, expected one of Windows");
    const bool hasTable = h.bits == 1 || h.bits == 4 || h.bits == 8;
    if (!hasTable && h.bits != 16 && h.bits != 24 && h.bits != 32)
        fail(fmt::format("pixels have {} bits, expected 1, 4, 8, 16, 24 or 32", h.bits));
    // 3: masks say where the colours are; in files of 32 bits they are where they are without.
    const bool hasMasks = h.packing == 3 && (h.bits == 16 || h.bits == 32);
    const bool hasRuns = h.packing == 1 && h.bits == 8 && h.height > 0;
    if (h.packing != 0 && !hasMasks && !hasRuns)
        fail(fmt::format("the pixels are packed in way {}, expected 0, runs of bytes (1) or masks "
                         "(3)",
                         h.packing));
    if (h.width < 0) fail("the width is negative");
    const uint64_t width = uint64_t(h.width), height = uint64_t(std::abs(h.height));
    const uint64_t rowBytes = (width * h.bits + 31) / 32 * 4;
    // A run of two bytes holds at most 255 pixels. Elsewhere a part of the rows is shown, but not
    // next to nothing of a picture of any size.
    constexpr uint64_t leastPart = 256;
    requireSize(name, width, height, 4, bytes.size(),
                h.pixelsAt + (hasRuns ? width * height / 255 * 2
                                      : std::max(rowBytes, rowBytes * height / leastPart)));
    const size_t table = kFileHeader + h.infoSize;
    const uint64_t mostColors = hasTable ? uint64_t(1) << h.bits : 0;
    const uint64_t colors = h.colors == 0 ? mostColors : std::min<uint64_t>(h.colors, mostColors);
    if (hasTable && table + 4 * colors > bytes.size()) fail("the table of colours is truncated");
    if (hasMasks && bytes.size() < kFileHeader + kLeastInfo + 12) fail("the masks are truncated");
    const std::array<Mask, 3> masks = masksOf(bytes, h);
    const std::string runs =
        hasRuns ? unpacked(bytes.substr(std::min<size_t>(h.pixelsAt, bytes.size())), width, height)
                : std::string();
    const std::string_view pixels = hasRuns ? std::string_view(runs) : bytes;
    Picture picture{uint32_t(width), uint32_t(height), std::vector<uint8_t>()};
    auto& values = std::get<std::vector<uint8_t>>(picture.values);
    values.reserve(4 * picture.texelCount());
    bool isWhole = true;
    for (uint64_t row = 0; row < height; ++row) {
        const size_t line =
            (hasRuns ? 0 : h.pixelsAt) + rowBytes * (h.height < 0 ? row : height - 1 - row);
        if (line + rowBytes > pixels.size()) { // missing: mid grey
            for (uint64_t column = 0; column < width; ++column)
                values.insert(values.end(), {127, 127, 127, 255});
            isWhole = false;
            continue;
        }
        for (uint64_t column = 0; column < width; ++column) {
            size_t at = line + column * h.bits / 8;
            if (h.bits == 16) {
                for (const Mask& mask : masks)
                    values.push_back(mask.of(bytesAt(bytes, at, 2)));
                values.push_back(255);
                continue;
            }
            if (hasTable) {
                // The first pixel is in the highest bits.
                const uint64_t shift = 8 - h.bits - column * h.bits % 8;
                const uint64_t index = uint8_t(pixels[at]) >> shift & (mostColors - 1);
                if (index >= colors)
                    fail(fmt::format("a pixel names colour {} of {}", index, colors));
                at = table + 4 * index;
            }
            // Blue first. The fourth byte is nowhere said to be alpha.
            for (const size_t channel : {2, 1, 0})
                values.push_back(uint8_t(bytes[at + channel]));
            values.push_back(255);
        }
    }
    if (!isWhole) picture.addFault(build::Shortfall::PicturePart, "the file is truncated");
    return picture;
}

} // namespace stromboli::images
