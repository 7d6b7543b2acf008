#include "host/core/printable.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

using namespace std::string_literals;

TEST(Printable, LeavesTextInAnyLanguageAlone) {
    for (const char* text : {"", "Cornell box", "Würfel", "立方体", "куб", "\U0001F30B", "a\\b"})
        EXPECT_EQ(printable(text), text);
}

TEST(Printable, ShowsControlCharacters) {
    EXPECT_EQ(printable("\x1B[2J\x1B]0;title\x07"), "\\x1b[2J\\x1b]0;title\\x07");
    EXPECT_EQ(printable("a\nerror: b\tc\rd"), "a\\nerror: b\\tc\\x0dd");
    EXPECT_EQ(printable("a\0b\x7F"s), "a\\x00b\\x7f");
    // Controls of eight bits: U+0085 and U+009B, which begins a sequence on some terminals.
    EXPECT_EQ(printable("\xC2\x85|\xC2\x9B|\xC2\xA0"), "\\xc2\\x85|\\xc2\\x9b|\xC2\xA0");
}

TEST(Printable, ShowsBytesThatAreNoUtf8) {
    EXPECT_EQ(printable("W\xFCrfel"), "W\\xfcrfel");
    EXPECT_EQ(printable("\x9B"
                        "31m"),
              "\\x9b31m");
    EXPECT_EQ(printable("\xE4\xBD"), "\\xe4\\xbd") << "cut short";
    EXPECT_EQ(printable("\xC1\x9B"), "\\xc1\\x9b") << "longer than need be";
    EXPECT_EQ(printable("\xE0\x82\x9B"), "\\xe0\\x82\\x9b") << "longer than need be";
    EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
    EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last";
}

} // namespace
} // namespace stromboli::test
