#include "scene/images/block_compression.hpp"

#include <algorithm>

namespace stromboli::images {
namespace {

using Color = std::array<uint8_t, 4>;

unsigned shortAt(std::span<const uint8_t> bytes, size_t i) {
    return unsigned(bytes[i]) | unsigned(bytes[i + 1]) << 8;
}

/// Five, six and five bits, of which the highest become the lowest of a byte too.
Color colorOf(unsigned word) {
    const unsigned red = word >> 11, green = word >> 5 & 63, blue = word & 31;
    return {uint8_t(red << 3 | red >> 2), uint8_t(green << 2 | green >> 4),
            uint8_t(blue << 3 | blue >> 2), 255};
}

/// (a first + b second) / (a + b), rounded.
Color mean(const Color& first, unsigned a, const Color& second, unsigned b) {
    Color result{0, 0, 0, 255};
    for (size_t i = 0; i < 3; ++i)
        result[i] = uint8_t((a * first[i] + b * second[i] + (a + b) / 2) / (a + b));
    return result;
}

/// Eight bytes: two colours, and two bits a texel. `mayBeClear`: the order of the two says whether
/// the fourth colour is none.
void readColors(std::span<const uint8_t> bytes, bool mayBeClear, BlockTexels& texels) {
    const unsigned first = shortAt(bytes, 0), second = shortAt(bytes, 2);
    std::array<Color, 4> colors = {colorOf(first), colorOf(second)};
    const bool hasClear = mayBeClear && first <= second;
    colors[2] = hasClear ? mean(colors[0], 1, colors[1], 1) : mean(colors[0], 2, colors[1], 1);
    colors[3] = hasClear ? Color{0, 0, 0, 0} : mean(colors[0], 1, colors[1], 2);
    for (size_t i = 0; i < 16; ++i)
        texels[i] = colors[bytes[4 + i / 4] >> 2 * (i % 4) & 3];
}

/// Eight bytes: two values, and three bits a texel. The order of the two says whether there are six
/// values between them, or four and the least and the most.
std::array<uint8_t, 16> readChannel(std::span<const uint8_t> bytes, bool isSigned) {
    // Signed ones from -127 on, moved to where 1 stands for -1 and 128 for 0.
    const auto end = [&](uint8_t byte) {
        return isSigned ? std::max(int(int8_t(byte)), -127) + 128 : int(byte);
    };
    const int first = end(bytes[0]), second = end(bytes[1]);
    std::array<int, 8> values = {first, second};
    if (first > second) {
        for (int i = 1; i < 7; ++i)
            values[size_t(i) + 1] = ((7 - i) * first + i * second + 3) / 7;
    } else {
        for (int i = 1; i < 5; ++i)
            values[size_t(i) + 1] = ((5 - i) * first + i * second + 2) / 5;
        values[6] = isSigned ? 1 : 0;
        values[7] = 255;
    }
    uint64_t bits = 0;
    for (size_t i = 0; i < 6; ++i)
        bits |= uint64_t(bytes[2 + i]) << 8 * i;
    std::array<uint8_t, 16> channel;
    for (size_t i = 0; i < 16; ++i)
        channel[i] = uint8_t(values[bits >> 3 * i & 7]);
    return channel;
}

} // namespace

BlockTexels decodeBlock(BlockCompression kind, std::span<const uint8_t> bytes) {
    BlockTexels texels;
    const bool isSigned =
        kind == BlockCompression::Bc4Signed || kind == BlockCompression::Bc5Signed;
    switch (kind) {
    case BlockCompression::Bc1:
        readColors(bytes, true, texels);
        break;
    case BlockCompression::Bc2:
        readColors(bytes.subspan(8), false, texels);
        for (size_t i = 0; i < 16; ++i)
            texels[i][3] = uint8_t((bytes[i / 2] >> 4 * (i % 2) & 15) * 17);
        break;
    case BlockCompression::Bc3: {
        readColors(bytes.subspan(8), false, texels);
        const std::array<uint8_t, 16> alpha = readChannel(bytes, false);
        for (size_t i = 0; i < 16; ++i)
            texels[i][3] = alpha[i];
        break;
    }
    case BlockCompression::Bc4:
    case BlockCompression::Bc4Signed: {
        const std::array<uint8_t, 16> grey = readChannel(bytes, isSigned);
        for (size_t i = 0; i < 16; ++i)
            texels[i] = {grey[i], grey[i], grey[i], 255};
        break;
    }
    case BlockCompression::Bc5:
    case BlockCompression::Bc5Signed: {
        const std::array<uint8_t, 16> red = readChannel(bytes, isSigned);
        const std::array<uint8_t, 16> green = readChannel(bytes.subspan(8), isSigned);
        for (size_t i = 0; i < 16; ++i)
            texels[i] = {red[i], green[i], 0, 255};
        break;
    }
    case BlockCompression::Bc7:
        return decodeBc7(bytes.first<16>());
    }
    return texels;
}

} // namespace stromboli::images
