// Windows bitmaps, from bytes made here.
#include "host/core/error.hpp"
#include "scene/images/picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

using images::decodePicture;
using images::Picture;
using testing::ElementsAre;
using testing::HasSubstr;

/// The lowest byte first.
void put(std::string& bytes, uint32_t value, int count) {
    for (int i = 0; i < count; ++i, value >>= 8)
        bytes += char(value & 0xFF);
}

/// pixels: as the file has them, behind a table of colours.
std::string bitmap(int width, int height, int bits, const std::string& pixels,
                   const std::string& table = "", int packing = 0) {
    std::string bytes = "BM";
    put(bytes, 0, 8);
    put(bytes, uint32_t(54 + table.size()), 4);
    put(bytes, 40, 4);
    put(bytes, uint32_t(width), 4), put(bytes, uint32_t(height), 4);
    put(bytes, 1, 2), put(bytes, uint32_t(bits), 2), put(bytes, uint32_t(packing), 4);
    put(bytes, 0, 12);
    put(bytes, uint32_t(table.size() / 4), 4), put(bytes, 0, 4);
    return bytes + table + pixels;
}

std::vector<uint8_t> texelsOf(const std::string& bytes) {
    return std::get<std::vector<uint8_t>>(decodePicture(bytes, "picture").values);
}

/// Two pixels of three bytes are filled up to eight.
const std::string kRows =
    std::string("\x01\x02\x03\x04\x05\x06\0\0", 8) + std::string("\x07\x08\x09\x0a\x0b\x0c\0\0", 8);

TEST(Bitmaps, BeginAtTheBottomWithBlue) {
    EXPECT_THAT(texelsOf(bitmap(2, 2, 24, kRows)),
                ElementsAre(9, 8, 7, 255, 12, 11, 10, 255, 3, 2, 1, 255, 6, 5, 4, 255));
    EXPECT_THAT(texelsOf(bitmap(2, -2, 24, kRows)),
                ElementsAre(3, 2, 1, 255, 6, 5, 4, 255, 9, 8, 7, 255, 12, 11, 10, 255));
    EXPECT_THAT(texelsOf(bitmap(1, 1, 32, "\x01\x02\x03\x04")), ElementsAre(3, 2, 1, 255));
}

TEST(Bitmaps, MayNameColoursOfATable) {
    const std::string table("\x01\x02\x03\0\x04\x05\x06\0", 8);
    EXPECT_THAT(texelsOf(bitmap(2, 1, 8, std::string("\x01\0\0\0", 4), table)),
                ElementsAre(6, 5, 4, 255, 3, 2, 1, 255));
}

/// The first pixel is in the highest bits, and rows are filled up to four bytes.
TEST(Bitmaps, MayHaveSeveralPixelsInAByte) {
    const std::string table("\x01\x02\x03\0\x04\x05\x06\0", 8);
    EXPECT_THAT(texelsOf(bitmap(3, 1, 1, std::string("\xA0\0\0\0", 4), table)),
                ElementsAre(6, 5, 4, 255, 3, 2, 1, 255, 6, 5, 4, 255));
    EXPECT_THAT(texelsOf(bitmap(3, 1, 4, std::string("\x01\x10\0\0", 4), table)),
                ElementsAre(3, 2, 1, 255, 6, 5, 4, 255, 6, 5, 4, 255));
}

TEST(Bitmaps, MayHaveSixteenBitsOfFivesOrByMasks) {
    // 31 of red and 16 of blue; without a word about it the highest bit has no meaning.
    EXPECT_THAT(texelsOf(bitmap(1, 1, 16, std::string("\x10\xFC\0\0", 4))),
                ElementsAre(255, 0, 132, 255));
    // As if the masks were a table: they stand where one would.
    std::string masks;
    for (const uint32_t mask : {0xF800u, 0x07E0u, 0x001Fu})
        put(masks, mask, 4);
    EXPECT_THAT(texelsOf(bitmap(1, 1, 16, std::string("\xF0\x07\0\0", 4), masks, 3)),
                ElementsAre(0, 255, 132, 255));
}

/// Runs, single pixels, ends of lines, steps and the end.
TEST(Bitmaps, MayBePackedInRuns) {
    const std::string table("\0\0\0\0\1\1\1\0\2\2\2\0", 12);
    const std::string runs("\3\1\0\0\0\3\1\2\1\0\0\0\0\2\2\0\1\2\0\1\3\2", 22);
    const std::vector<uint8_t> texels = texelsOf(bitmap(3, 3, 8, runs, table, 1));
    std::vector<int> colors;
    for (size_t i = 0; i < texels.size(); i += 4)
        colors.push_back(texels[i]);
    EXPECT_THAT(colors, ElementsAre(0, 0, 2, 1, 2, 1, 1, 1, 1));
}

std::string problemOf(const std::string& bytes) {
    try {
        decodePicture(bytes, "picture");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

/// Rows that are there are shown, those at the bottom first, and what is missing is mid grey.
TEST(Bitmaps, ThatEndTooEarlyAreShownAsFarAsTheyGo) {
    const Picture picture = decodePicture(bitmap(2, 2, 24, kRows.substr(0, 15)), "picture");
    EXPECT_THAT(std::get<std::vector<uint8_t>>(picture.values),
                ElementsAre(127, 127, 127, 255, 127, 127, 127, 255, 3, 2, 1, 255, 6, 5, 4, 255));
    ASSERT_EQ(picture.faults.size(), 1u);
    EXPECT_EQ(picture.faults[0].problem, "the file is truncated");
    EXPECT_THAT(problemOf(bitmap(2, 2, 24, kRows.substr(0, 7))), HasSubstr("truncated"));
}

TEST(Bitmaps, WrongOnesSayWhy) {
    EXPECT_THAT(problemOf("BM"), HasSubstr("the header is truncated"));
    EXPECT_THAT(problemOf(bitmap(2, 2, 12, kRows)), HasSubstr("pixels have 12 bits"));
    EXPECT_THAT(problemOf(bitmap(200, 200, 8, "\1\0", std::string(8, '\0'), 1)),
                HasSubstr("cannot hold"));
    EXPECT_THAT(problemOf(bitmap(2, 2, 24, kRows, "", 1)), HasSubstr("packed in way 1"));
    EXPECT_THAT(problemOf(bitmap(200, 2, 24, kRows)), HasSubstr("truncated"));
    EXPECT_THAT(problemOf(bitmap(-2, 2, 24, kRows)), HasSubstr("width is negative"));
    EXPECT_THAT(problemOf(bitmap(1, 1, 8, std::string("\x05\0\0\0", 4), std::string(8, '\0'))),
                HasSubstr("names colour 5 of 2"));
}

/// No byte makes the reader do anything but read or refuse.
TEST(Bitmaps, AnyByteMayBeWrong) {
    const std::string runs("\3\1\0\0\0\3\1\2\1\0\0\1", 12);
    for (const std::string& good :
         {bitmap(2, 2, 24, kRows), bitmap(3, 2, 8, runs, std::string(12, '\1'), 1),
          bitmap(2, 2, 16, kRows, std::string(12, '\1'), 3)})
        for (size_t i = 2; i < good.size(); ++i)
            for (int bit = 0; bit < 8; ++bit) {
                std::string bad = good;
                bad[i] = char(bad[i] ^ 1 << bit);
                problemOf(bad);
            }
}

} // namespace
} // namespace stromboli::test
