#include "host/core/error.hpp"
#include "scene/images/picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

namespace stromboli::images {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<uint8_t>;

std::string ddsWords(const std::vector<uint32_t>& values) {
    std::string bytes;
    for (const uint32_t value : values)
        for (int i = 0; i < 4; ++i)
            bytes += char(value >> 8 * i & 255u);
    return bytes;
}

/// The header of a picture; `format`: flags, a code of four bytes, bits and masks.
std::string ddsHeader(uint32_t width, uint32_t height, const std::string& format,
                      uint32_t caps = 0) {
    return "DDS " + ddsWords({124, 0x1007, height, width, 0, 0, 0}) + std::string(44, '\0') +
           ddsWords({32}) + format + ddsWords({0x1000, caps, 0, 0, 0});
}

std::string coded(const std::string& code) {
    return ddsWords({4}) + code + ddsWords({0, 0, 0, 0, 0});
}

std::string masked(uint32_t flags, const std::vector<uint32_t>& bitsAndMasks) {
    return ddsWords({flags, 0}) + ddsWords(bitsAndMasks);
}

std::string dxgi(uint32_t width, uint32_t height, uint32_t format) {
    return ddsHeader(width, height, coded("DX10")) + ddsWords({format, 3, 0, 1, 0});
}

template <class Values = Bytes>
Values ddsValues(const std::string& bytes) {
    return std::get<Values>(decodePicture(bytes, "a.dds").values);
}

Bytes texelOf(const std::string& bytes, size_t i) {
    const Bytes values = ddsValues(bytes);
    return Bytes(values.begin() + std::ptrdiff_t(4 * i),
                 values.begin() + std::ptrdiff_t(4 * i + 4));
}

/// Red (0xF800) and blue (0x1F), of which the larger number is the first, and the indices 0, 1, 2,
/// 3 in each row.
const std::string kRedToBlue = std::string("\x00\xF8\x1F\x00\xE4\xE4\xE4\xE4", 8);
const std::string kBlueToRed = std::string("\x1F\x00\x00\xF8\xE4\xE4\xE4\xE4", 8);

TEST(Dds, Bc1HasTwoColoursAndTheirMeans) {
    const std::string file = ddsHeader(4, 4, coded("DXT1")) + kRedToBlue;
    EXPECT_THAT(texelOf(file, 0), ElementsAre(255, 0, 0, 255));
    EXPECT_THAT(texelOf(file, 1), ElementsAre(0, 0, 255, 255));
    EXPECT_THAT(texelOf(file, 2), ElementsAre(170, 0, 85, 255));
    EXPECT_THAT(texelOf(file, 15), ElementsAre(85, 0, 170, 255));
    // In the other order the fourth is none, and the third their mean.
    const std::string clear = ddsHeader(4, 4, coded("DXT1")) + kBlueToRed;
    EXPECT_THAT(texelOf(clear, 2), ElementsAre(128, 0, 128, 255));
    EXPECT_THAT(texelOf(clear, 3), ElementsAre(0, 0, 0, 0));
}

TEST(Dds, Bc2AndBc3HaveAlphaBeforeTheColours) {
    const std::string four = ddsHeader(4, 4, coded("DXT3")) + "\x10\x32\x54\x76\x98\xBA\xDC\xFE";
    EXPECT_THAT(texelOf(four + kBlueToRed, 0), ElementsAre(0, 0, 255, 0));
    EXPECT_THAT(texelOf(four + kBlueToRed, 7), ElementsAre(170, 0, 85, 119)); // never clear
    // From 255 to 0: of texels 0 to 3 the indices 0, 1, 2 and 7.
    const std::string eight =
        ddsHeader(4, 4, coded("DXT5")) + std::string("\xFF\x00\x88\x0E\0\0\0\0", 8);
    const std::array<int, 5> alpha = {255, 0, 219, 36, 255};
    for (size_t i = 0; i < alpha.size(); ++i)
        EXPECT_EQ(texelOf(eight + kBlueToRed, i).at(3), alpha[i]) << i;
}

TEST(Dds, Bc4IsGrey) {
    // From 10 to 60 in fifths, then 0 and 255: the indices 0, 1, 2, 6, 7.
    const std::string block = std::string("\x0A\x3C\x88\x7C\0\0\0\0", 8);
    for (const std::string& file : {ddsHeader(4, 4, coded("ATI1")), dxgi(4, 4, 80)}) {
        EXPECT_THAT(texelOf(file + block, 0), ElementsAre(10, 10, 10, 255));
        EXPECT_THAT(texelOf(file + block, 1), ElementsAre(60, 60, 60, 255));
        EXPECT_THAT(texelOf(file + block, 2), ElementsAre(20, 20, 20, 255));
        EXPECT_THAT(texelOf(file + block, 3), ElementsAre(0, 0, 0, 255));
        EXPECT_THAT(texelOf(file + block, 4), ElementsAre(255, 255, 255, 255));
    }
}

/// Normal maps, whose third number follows from the others: (0.6, 0, 0.8), and (1, 1), which is as
/// long as it can be.
TEST(Dds, Bc5HasTheBlueOfANormalMap) {
    const auto block = [](uint8_t red, uint8_t green) {
        std::string bytes;
        for (const uint8_t value : {red, green})
            bytes += std::string(2, char(value)) + std::string(6, '\0');
        return bytes;
    };
    for (const std::string& file : {ddsHeader(4, 4, coded("ATI2")), dxgi(4, 4, 83)}) {
        EXPECT_THAT(texelOf(file + block(204, 128), 5), ElementsAre(204, 128, 229, 255));
        EXPECT_THAT(texelOf(file + block(255, 255), 5), ElementsAre(255, 255, 128, 255));
    }
    // The channels may be numbers from -127 to 127.
    EXPECT_THAT(texelOf(dxgi(4, 4, 84) + block(76, 0), 5), ElementsAre(204, 128, 229, 255));
    EXPECT_THAT(texelOf(dxgi(4, 4, 84) + block(0x81, 0), 5), ElementsAre(1, 128, 143, 255));
}

/// Bits of a block, the lowest first.
struct Bc7Block {
    std::string bytes = std::string(16, '\0');
    unsigned at = 0;
    void put(unsigned value, unsigned count) {
        for (unsigned i = 0; i < count; ++i, ++at)
            bytes[at / 8] = char(uint8_t(bytes[at / 8]) | (value >> i & 1u) << at % 8);
    }
};

/// Kind 6: colours and alpha of seven bits and a lowest one, and four bits a texel.
TEST(Dds, Bc7OfOnePair) {
    Bc7Block block;
    block.put(1u << 6, 7);
    for (const unsigned end : {0u, 127u, 127u, 0u, 64u, 64u, 127u, 0u})
        block.put(end, 7);
    block.put(0, 1), block.put(1, 1);  // the lowest bits
    block.put(0, 3);                   // texel 0
    block.put(15, 4), block.put(5, 4); // 1 and 2
    const std::string file = dxgi(4, 4, 98) + block.bytes;
    EXPECT_THAT(texelOf(file, 0), ElementsAre(0, 254, 128, 254));
    EXPECT_THAT(texelOf(file, 1), ElementsAre(255, 1, 129, 1));
    // 21 of 64 parts of the second.
    EXPECT_THAT(texelOf(file, 2), ElementsAre(84, 171, 128, 171));
}

/// Kind 1: two pairs, here in the halves of way 13; six bits and one for each pair.
TEST(Dds, Bc7OfTwoPairs) {
    Bc7Block block;
    block.put(1u << 1, 2), block.put(13, 6);
    for (int channel = 0; channel < 3; ++channel)
        for (const unsigned end : {0u, 63u, 63u, 0u})
            block.put(end, 6);
    block.put(1, 1), block.put(0, 1);
    for (unsigned i = 0; i < 16; ++i) // the first bit of texels 0 and 15 is left out
        block.put(i == 7 ? 7 : 0, i == 0 || i == 15 ? 2 : 3);
    const std::string file = dxgi(4, 4, 98) + block.bytes;
    // Seven bits: 0000001 becomes 00000010, 1111110 becomes 11111101.
    EXPECT_THAT(texelOf(file, 0), ElementsAre(2, 2, 2, 255));
    EXPECT_THAT(texelOf(file, 7), ElementsAre(255, 255, 255, 255));
    EXPECT_THAT(texelOf(file, 8), ElementsAre(253, 253, 253, 255));
    EXPECT_THAT(texelOf(file, 15), ElementsAre(253, 253, 253, 255));
}

TEST(Dds, TexelsOneByOneHaveMasks) {
    const std::string blueFirst = masked(0x41, {32, 0xFF0000, 0xFF00, 0xFF, 0xFF000000});
    EXPECT_THAT(ddsValues(ddsHeader(1, 1, blueFirst) + "\x03\x02\x01\x04"),
                ElementsAre(1, 2, 3, 4));
    const std::string three = masked(0x40, {24, 0xFF0000, 0xFF00, 0xFF, 0});
    EXPECT_THAT(ddsValues(ddsHeader(1, 2, three) + "\x03\x02\x01\x06\x05\x04"),
                ElementsAre(1, 2, 3, 255, 4, 5, 6, 255));
    const std::string short565 = masked(0x40, {16, 0xF800, 0x7E0, 0x1F, 0});
    EXPECT_THAT(ddsValues(ddsHeader(1, 1, short565) + std::string("\x1F\x80", 2)),
                ElementsAre(132, 0, 255, 255));
    const std::string grey = masked(0x20001, {16, 0xFF, 0, 0, 0xFF00});
    EXPECT_THAT(ddsValues(ddsHeader(1, 1, grey) + "\x09\x50"), ElementsAre(9, 9, 9, 80));
}

TEST(Dds, NumbersOfSixteenBitsAndFloats) {
    const std::string four = std::string("\x01\0\x02\x01\xFF\xFF\x03\0", 8);
    EXPECT_THAT(ddsValues<std::vector<uint16_t>>(dxgi(1, 1, 11) + four),
                ElementsAre(1, 258, 65535, 3));
    const std::string halves = std::string("\0\x3C\0\x40\0\x38\0\x3C", 8);
    EXPECT_THAT(ddsValues<std::vector<float>>(dxgi(1, 1, 10) + halves), ElementsAre(1, 2, 0.5f, 1));
    EXPECT_THAT(ddsValues<std::vector<float>>(dxgi(1, 1, 41) + ddsWords({0x40400000})),
                ElementsAre(3, 3, 3, 1));
}

/// Four blocks cover 5 x 5 texels; three of them have texels that nobody sees.
TEST(Dds, SidesNeedNoMultipleOfFour) {
    const std::string white = std::string("\xFF\xFF\xFF\xFF\0\0\0\0", 8);
    const std::string file =
        ddsHeader(5, 5, coded("DXT1")) + kRedToBlue + white + white + kRedToBlue;
    EXPECT_EQ(ddsValues(file).size(), 5u * 5 * 4);
    EXPECT_THAT(texelOf(file, 4), ElementsAre(255, 255, 255, 255));
    EXPECT_THAT(texelOf(file, 24), ElementsAre(255, 0, 0, 255));
}

TEST(Dds, ThatEndsTooEarlyIsShownAsFarAsItGoes) {
    const Picture picture = decodePicture(ddsHeader(8, 4, coded("DXT1")) + kRedToBlue, "a.dds");
    const auto& values = std::get<Bytes>(picture.values);
    EXPECT_EQ(values.at(0), 255);
    EXPECT_EQ(values.at(16), 127);
    EXPECT_EQ(values.at(19), 255);
    ASSERT_EQ(picture.faults.size(), 1u);
    EXPECT_EQ(picture.faults[0].kind, build::Shortfall::PicturePart);
}

TEST(Dds, WhatIsNotReadIsSaid) {
    const auto messageOf = [](const std::string& bytes) -> std::string {
        try {
            decodePicture(bytes, "a.dds");
        } catch (const SceneError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_THAT(messageOf("DDS "), HasSubstr("cannot be read as DDS: the file is truncated"));
    EXPECT_THAT(messageOf(ddsHeader(4, 4, coded("UYVY"))),
                HasSubstr("its format 'UYVY' is not read"));
    EXPECT_THAT(messageOf(dxgi(4, 4, 95)), HasSubstr("DXGI 95, is not read"));
    EXPECT_THAT(messageOf(ddsHeader(4, 4, coded("DXT1"), 0x200)), HasSubstr("cube"));
    EXPECT_THAT(messageOf(ddsHeader(4, 4, coded("DXT1"))), HasSubstr("truncated"));
    EXPECT_THAT(messageOf(ddsHeader(99999, 4, coded("DXT1")) + kRedToBlue), HasSubstr("99999 x 4"));
}

TEST(Dds, AnyBytesAreAPicture) {
    std::mt19937 random(4);
    for (const uint32_t format : {71, 74, 77, 80, 81, 83, 84, 98})
        for (int i = 0; i < 200; ++i) {
            std::string file = dxgi(4, 4, format);
            for (int byte = 0; byte < 16; ++byte)
                file += char(random());
            EXPECT_EQ(ddsValues(file).size(), 64u);
        }
}

} // namespace
} // namespace stromboli::images
