// Frames: half floats, their scale, the bytes that pages are sent.
#include "host/view/frame.hpp"
#include "tests/view/served_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::view {
namespace {

using namespace test;

TEST(HalfFloats, AllAreTheirOwnNearest) {
    for (uint32_t half = 0; half < 0x10000; ++half) {
        const float value = valueOfHalf(uint16_t(half));
        if (std::isnan(value))
            EXPECT_EQ(halfOf(value), 0) << half;
        else
            EXPECT_EQ(halfOf(value), half) << value;
    }
}

TEST(HalfFloats, BetweenTwoTheNearerIsTakenAndTheEvenOneInTheMiddle) {
    for (uint32_t half = 0; half < 0x7BFF; ++half) {
        const double low = valueOfHalf(uint16_t(half)), high = valueOfHalf(uint16_t(half + 1));
        const auto middle = float((low + high) / 2); // has one digit more: exact
        EXPECT_EQ(halfOf(middle), half % 2 == 0 ? half : half + 1) << half;
        EXPECT_EQ(halfOf(std::nextafter(middle, 0.0f)), half);
        EXPECT_EQ(halfOf(std::nextafter(middle, INFINITY)), half + 1);
        EXPECT_EQ(halfOf(-middle), halfOf(middle) | 0x8000);
    }
}

TEST(HalfFloats, WhatIsTooLargeIsInfinite) {
    EXPECT_EQ(halfOf(65519.996f), 0x7BFF);
    EXPECT_EQ(halfOf(65520.0f), 0x7C00);
    EXPECT_EQ(halfOf(1e30f), 0x7C00);
    EXPECT_EQ(halfOf(-INFINITY), 0xFC00);
}

TEST(FrameScale, BringsTheLargestToWhereHalfFloatsHaveAllTheirDigits) {
    EXPECT_EQ(exponentFor(std::vector<float>{}), 0);
    EXPECT_EQ(exponentFor(std::vector{0.0f, INFINITY, NAN}), 0);
    EXPECT_EQ(exponentFor(std::vector{1.0f, 32768.0f}), 0);
    for (const float most : {33000.0f, 1e6f, 3e38f, 1e-3f, 1e-30f, 1e-44f}) {
        const double scaled = std::ldexp(double(most), -exponentFor(std::vector{most, INFINITY}));
        EXPECT_GE(scaled, 16384) << most;
        EXPECT_LT(scaled, 32768) << most;
    }
}

TEST(Frames, AreReadAsTheyWereWritten) {
    for (const std::string text : {R"({"a":1,"width":2,"height":1,"channels":2,"exponent":4})",
                                   R"({"width":2,"height":1,"channels":2,"exponent":4})"}) {
        const Raster raster{2, 1, 2, {16, 0.5f, 48, INFINITY}};
        const ReadFrame frame = readFrame(encodeFrame(text, raster, 4));
        EXPECT_EQ(frame.text.substr(0, text.size()), text);
        EXPECT_EQ(frame.values, raster.values);
    }
}

} // namespace
} // namespace stromboli::view
