#include "scene/build/unicode.hpp"

#include <gtest/gtest.h>

namespace stromboli::build {
namespace {

using namespace std::string_literals;

std::string swapped(std::string bytes) {
    for (size_t i = 0; i + 1 < bytes.size(); i += 2)
        std::swap(bytes[i], bytes[i + 1]);
    return bytes;
}

TEST(Utf16, BecomesUtf8) {
    // a, U+00FC, U+07FF, U+0800, U+7ACB, U+FFFD, U+1F30B, U+10FFFF
    const std::string text =
        "a\0\xFC\0\xFF\x07\0\x08\xCB\x7A\xFD\xFF\x3C\xD8\x0B\xDF\xFF\xDB\xFF\xDF"s;
    const std::string expected =
        "a\xC3\xBC\xDF\xBF\xE0\xA0\x80\xE7\xAB\x8B\xEF\xBF\xBD\xF0\x9F\x8C\x8B\xF4\x8F\xBF\xBF";
    EXPECT_EQ(utf8FromUtf16(text, ByteOrder::LittleEndian), expected);
    EXPECT_EQ(utf8FromUtf16(swapped(text), ByteOrder::BigEndian), expected);
    EXPECT_EQ(utf8FromUtf16("", ByteOrder::BigEndian), "");
}

TEST(Utf16, HalfACharacterIsNone) {
    for (const std::string& half : {"a"s, "a\0b"s, "\x3C\xD8"s, "\x3C\xD8"s + "a\0"s, "\x0B\xDF"s})
        EXPECT_FALSE(utf8FromUtf16(half, ByteOrder::LittleEndian));
}

TEST(Utf16, IsToldByItsMarkOrItsFirstCharacter) {
    const auto order = [](const std::string& bytes) { return utf16Beginning(bytes).value().order; };
    EXPECT_EQ(order("\xFF\xFE<\0"s), ByteOrder::LittleEndian);
    EXPECT_EQ(order("\xFE\xFF\0<"s), ByteOrder::BigEndian);
    EXPECT_EQ(order("<\0"s), ByteOrder::LittleEndian);
    EXPECT_EQ(order("\0<"s), ByteOrder::BigEndian);
    EXPECT_TRUE(utf16Beginning("\xFE\xFF\0<"s)->marked);
    EXPECT_FALSE(utf16Beginning("\0<"s)->marked);
    for (const std::string& other : {""s, "<"s, "<C"s, "\xEF\xBB\xBF<"s, "\0\0"s, "\x01\0"s})
        EXPECT_FALSE(utf16Beginning(other));
}

TEST(Unicode, BytesThatAreNone) {
    EXPECT_EQ(utf8WithLatin1("caf\xE9 caf\xC3\xA9"), "caf\xC3\xA9 caf\xC3\xA9");
    EXPECT_EQ(utf8WithLatin1("\xE2\x82\xAC \xF0\x9F\x98\x80"), "\xE2\x82\xAC \xF0\x9F\x98\x80");
    EXPECT_EQ(utf8WithLatin1("\xC0\x80"), "\xC3\x80\xC2\x80"); // a zero in two bytes is none
    EXPECT_EQ(utf8WithLatin1("\xE2\x82"), "\xC3\xA2\xC2\x82");
    EXPECT_EQ(latin1FromUtf8("caf\xC3\xA9"), "caf\xE9");
    EXPECT_EQ(latin1FromUtf8("\xE2\x82\xAC"), std::nullopt);
}

} // namespace
} // namespace stromboli::build
