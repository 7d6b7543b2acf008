#include "host/core/text.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace stromboli {
namespace {

TEST(NumberText, WholeNumbersComeOutWhole) {
    for (const auto& [text, value] : std::initializer_list<std::pair<const char*, uint64_t>>{
             {"0", 0},
             {"-0", 0},
             {"007", 7},
             {"1k", 1000},
             {"1M", 1'000'000},
             {"1e6", 1'000'000},
             {"1E+6", 1'000'000},
             {"2.5k", 2500},
             {"2.3k", 2300}, // 2.3 * 1000 is 2299.9999999999995 in double
             {"1.000001M", 1'000'001},
             {"1e-3k", 1},
             {"1500e-2", 15},
             {"5.", 5},
             {".5k", 500},
             {"0e999999", 0},
             {"18446744073709551615", UINT64_MAX},
             {"1.8446744073709551615e19", UINT64_MAX}})
        EXPECT_EQ(wholeNumber(text), value) << text;
}

TEST(NumberText, WhatIsNotWholeOrTooLargeIsNone) {
    for (const char* text : {"",
                             "-1",
                             "1.5",
                             "1.0001k",
                             "1e-1",
                             "18446744073709551616",
                             "1e20",
                             "1e999999999999",
                             "99999999999999M",
                             "k",
                             ".",
                             "e3",
                             "1e",
                             "1e+",
                             "1x",
                             "1kk",
                             "1K",
                             "1m",
                             " 1",
                             "1 ",
                             "+1",
                             "0x10",
                             "nan",
                             "inf",
                             "1,000",
                             "1.2.3"})
        EXPECT_FALSE(wholeNumber(text)) << text;
}

TEST(NumberText, RealsAreTheNearestDoubles) {
    for (const char* text : {"0.05", "-1.5", "1e-6", "1e300", "123456789.123456789", "0", "-0",
                             "2.2250738585072014e-308", "5"})
        EXPECT_EQ(realNumber(text), std::strtod(text, nullptr)) << text;
    EXPECT_EQ(realNumber("2.3k"), 2300);
    EXPECT_EQ(realNumber("0.1M"), 100000);
    for (const char* text : {"", "nan", "-nan", "inf", "-inf", "infinity", "1e999", "1e-999", "1x",
                             "0x1p3", "1..2", "--1"})
        EXPECT_FALSE(realNumber(text)) << text;
}

} // namespace
} // namespace stromboli
