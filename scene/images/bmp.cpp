// Windows bitmaps (Microsoft, "Bitmap Storage"): a file header of 14 bytes, one about the picture,
// a table of colours, and rows of pixels from the bottom, each filled up to four bytes. Those that
// are not packed are read.

#include "scene/images/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
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

} // namespace

Picture decodeBmp(std::string_view bytes, const std::string& name) {
    const auto fail = [&](const std::string& problem) { failToDecode(name, "BMP", problem); };
    if (bytes.size() < kFileHeader + kLeastInfo) fail("the header is truncated");
    const Header h = headerOf(bytes);
    if (h.infoSize < kLeastInfo) fail("it is of OS/2, expected one of Windows");
    const bool hasTable = h.bits == 8;
    if (!hasTable && h.bits != 24 && h.bits != 32)
        fail(fmt::format("pixels have {} bits, expected 8, 24 or 32", h.bits));
    // 3: masks say where the colours are; in files of 32 bits they are where they are without.
    if (h.packing != 0 && !(h.packing == 3 && h.bits == 32))
        fail(fmt::format("the pixels are packed in way {}, expected 0", h.packing));
    if (h.width < 0) fail("the width is negative");
    const uint64_t width = uint64_t(h.width), height = uint64_t(std::abs(h.height));
    const uint64_t rowBytes = (width * h.bits / 8 + 3) / 4 * 4;
    requireSize(name, width, height, 4, bytes.size(), h.pixelsAt + rowBytes * height);
    const size_t table = kFileHeader + h.infoSize;
    const uint64_t colors = h.colors == 0 ? 256 : std::min(h.colors, 256u);
    if (hasTable && table + 4 * colors > bytes.size()) fail("the table of colours is truncated");
    Picture picture{uint32_t(width), uint32_t(height), std::vector<uint8_t>()};
    auto& values = std::get<std::vector<uint8_t>>(picture.values);
    values.reserve(4 * picture.texelCount());
    for (uint64_t row = 0; row < height; ++row) {
        const size_t line = h.pixelsAt + rowBytes * (h.height < 0 ? row : height - 1 - row);
        for (uint64_t column = 0; column < width; ++column) {
            size_t at = line + column * (h.bits / 8);
            if (hasTable) {
                const uint64_t index = uint8_t(bytes[at]);
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
    return picture;
}

} // namespace stromboli::images
