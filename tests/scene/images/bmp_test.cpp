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

std::string problemOf(const std::string& bytes) {
    try {
        decodePicture(bytes, "picture");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(Bitmaps, WrongOnesSayWhy) {
    EXPECT_THAT(problemOf("BM"), HasSubstr("the header is truncated"));
    EXPECT_THAT(problemOf(bitmap(2, 2, 16, kRows)), HasSubstr("pixels have 16 bits"));
    EXPECT_THAT(problemOf(bitmap(2, 2, 24, kRows, "", 1)), HasSubstr("packed in way 1"));
    EXPECT_THAT(problemOf(bitmap(200, 2, 24, kRows)), HasSubstr("truncated"));
    EXPECT_THAT(problemOf(bitmap(-2, 2, 24, kRows)), HasSubstr("width is negative"));
    EXPECT_THAT(problemOf(bitmap(1, 1, 8, std::string("\x05\0\0\0", 4), std::string(8, '\0'))),
                HasSubstr("names colour 5 of 2"));
}

/// No byte makes the reader do anything but read or refuse.
TEST(Bitmaps, AnyByteMayBeWrong) {
    const std::string good = bitmap(2, 2, 24, kRows);
    for (size_t i = 2; i < good.size(); ++i)
        for (int bit = 0; bit < 8; ++bit) {
            std::string bad = good;
            bad[i] = char(bad[i] ^ 1 << bit);
            problemOf(bad);
        }
}

} // namespace
} // namespace stromboli::test
