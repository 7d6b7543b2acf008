// Exposure and white balance that are found out from the picture.
#include "host/core/color.hpp"
#include "host/film/metering.hpp"
#include "host/film/tone_mapping.hpp"
#include "host/film/white_balance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace stromboli {
namespace {

using Colors = std::vector<glm::vec3>;

/// Grey radiance whose logarithm is normally distributed, as that of most pictures is nearly:
/// about 2^center, with a standard deviation of `spread` stops.
Colors room(double center, double spread, size_t count = 20'000) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> stops(center, spread);
    Colors colors(count);
    for (glm::vec3& color : colors)
        color = glm::vec3(float(std::exp2(stops(random))));
    return colors;
}

// --- Exposure ------------------------------------------------------------------------------------

TEST(MeteredExposure, BringsAGreyPictureToMiddleGrey) {
    for (const double radiance : {1e-6, 0.02, 0.18, 1.0, 700.0})
        EXPECT_NEAR(meteredExposure(Colors(100, glm::vec3(float(radiance)))),
                    std::log2(0.18 / radiance), 0.0051)
            << radiance; // it is rounded to hundredths
}

TEST(MeteredExposure, GoesByLuminance) {
    const glm::vec3 green(0, 1, 0);
    EXPECT_NEAR(meteredExposure(Colors(10, green)), std::log2(0.18 / 0.7152), 0.0051);
}

TEST(MeteredExposure, OfTwiceThePictureIsOneStopLess) {
    Colors picture = room(-3, 2);
    const double before = meteredExposure(picture);
    for (glm::vec3& color : picture)
        color *= 2.0f;
    EXPECT_NEAR(meteredExposure(picture), before - 1, 1e-9);
}

/// The mean of all but 5 of 100 at either end moves by no more than what its ends let through: of
/// 0.1 % of the pixels, 0.001 / 0.9 of the 6.6 stops between these ends; and the result is rounded.
TEST(MeteredExposure, LampsHardlyMatter) {
    Colors picture = room(-3, 2);
    const double before = meteredExposure(picture);
    for (size_t i = 0; i < picture.size() / 1000; ++i)
        picture[i * 1000] = glm::vec3(1e6f);
    EXPECT_NEAR(meteredExposure(picture), before, 0.0074 + 0.01);
    EXPECT_LE(meteredExposure(picture), before);
}

/// As it is behind most models: black, or nearly so by what a pixel filter or a dim sky leaves.
TEST(MeteredExposure, BackgroundDoesNotMatter) {
    const Colors model = room(-3, 1);
    Colors picture = model;
    picture.resize(5 * model.size(), glm::vec3(0));
    EXPECT_EQ(meteredExposure(picture), meteredExposure(model));
    for (size_t i = model.size(); i < picture.size(); i += 100)
        picture[i] = glm::vec3(1e-9f);
    EXPECT_EQ(meteredExposure(picture), meteredExposure(model));
}

TEST(MeteredExposure, WhatIsNoLightDoesNotMatter) {
    Colors picture = room(-3, 2, 1000);
    const double before = meteredExposure(picture);
    for (const float none :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -5.0f})
        picture.insert(picture.end(), 200, glm::vec3(none));
    EXPECT_EQ(meteredExposure(picture), before);
}

TEST(MeteredExposure, OfNothingIsNone) {
    EXPECT_EQ(meteredExposure({}), 0);
    EXPECT_EQ(meteredExposure(Colors(10, glm::vec3(0))), 0);
    EXPECT_EQ(meteredExposure(Colors(1, glm::vec3(0.18f))), 0);
}

/// What is said of it can be given again: hundredths, in the range of the option.
TEST(MeteredExposure, IsANumberOfTheOption) {
    const double found = meteredExposure(room(-2.345678, 1));
    EXPECT_NEAR(100 * found, std::round(100 * found), 1e-9);
    EXPECT_EQ(meteredExposure(Colors(3, glm::vec3(1e-37f))), 100);
    EXPECT_EQ(meteredExposure(Colors(3, glm::vec3(3e38f))), -100);
}

// --- White balance -------------------------------------------------------------------------------

Colors underLight(Colors colors, double kelvin) {
    const glm::dmat3 cast = glm::inverse(whiteBalance(kelvin));
    for (glm::vec3& color : colors)
        color = cast * glm::dvec3(color);
    return colors;
}

TEST(MeteredIlluminant, OfAGreyRoomIsItsLight) {
    for (const double kelvin : {2700.0, 3200.0, 5003.0, 6504.0, 9000.0})
        EXPECT_NEAR(*meteredIlluminant(underLight(room(-3, 2, 1000), kelvin)), kelvin,
                    0.002 * kelvin)
            << kelvin; // floats, and the rounding to whole kelvin
}

TEST(MeteredIlluminant, IsThatOfTheRoomAndNotOfALamp) {
    Colors picture = underLight(room(-3, 2), 3200);
    for (size_t i = 0; i < picture.size() / 100; ++i)
        picture[i * 100] = {100, 200, 4000};
    EXPECT_NEAR(*meteredIlluminant(picture), 3200, 10);
}

/// Red, green and blue things, without the darkest and the brightest 15 of 300, blue and green
/// ones.
TEST(MeteredIlluminant, IsOfTheMeanColour) {
    const glm::vec3 red(0.6, 0.2, 0.2), green(0.2, 0.6, 0.2), blue(0.2, 0.2, 0.6);
    Colors things;
    for (const glm::vec3& color : {red, green, blue})
        things.insert(things.end(), 100, color);
    const glm::vec3 mean = 100.0f * red + 85.0f * green + 85.0f * blue;
    EXPECT_EQ(meteredIlluminant(things), nearestTemperature(mean));
}

/// A bright thing weighs as much as a dark one, of which nine out of ten are.
TEST(MeteredIlluminant, EachPixelCountsTheSame) {
    Colors things(100, glm::vec3(0.2f));
    for (size_t i = 0; i < 10; ++i)
        things[i] = glm::vec3(0.05f, 0.05f, 0.03f);
    const double before = *meteredIlluminant(things);
    for (size_t i = 10; i < 100; ++i)
        things[i] *= 64.0f;
    EXPECT_EQ(*meteredIlluminant(things), before);
}

TEST(MeteredIlluminant, OfNothingIsNone) {
    EXPECT_FALSE(meteredIlluminant({}));
    EXPECT_FALSE(meteredIlluminant(Colors(10, glm::vec3(0))));
}

// --- Of a picture --------------------------------------------------------------------------------

FloatImage pictureOf(const Colors& colors) {
    FloatImage image(uint32_t(colors.size()), 1);
    for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < colors.size(); ++i)
            image.channel(kColorChannels[c])[i] = colors[i][c];
    return image;
}

/// The exposure is of what shows: after the white balance, and of the covered part of a pixel.
TEST(Metering, IsOfThePictureAsItShows) {
    const ToneMapping both{.metersExposure = true, .metersIlluminant = true};
    const ToneMapping found =
        resolved(both, pictureOf(underLight(Colors(50, glm::vec3(0.4f)), 3200)));
    EXPECT_FALSE(found.isOpen());
    EXPECT_NEAR(*found.illuminant, 3200, 5);
    EXPECT_NEAR(found.curve.exposure, std::log2(0.18 / 0.4), 0.011);
    EXPECT_EQ(metered(both, found), "exposure -1.15 EV, white balance 3200 K");

    FloatImage half = pictureOf(Colors(50, glm::vec3(0.2f)));
    half.channel(kAlphaChannel).assign(50, 0.5f);
    EXPECT_NEAR(resolved({.metersExposure = true}, half).curve.exposure, std::log2(0.18 / 0.4),
                0.011);
}

/// Blue light of a lamp's picture weighs more when the lamp shows as white.
TEST(Metering, ExposesWhatTheWhiteBalanceMakes) {
    const glm::vec3 blue(0.1f, 0.1f, 0.8f);
    const double before = luminance(blue), after = luminance(whiteBalance(2500) * glm::dvec3(blue));
    ASSERT_GT(std::log2(after / before), 0.1);
    const ToneMapping found =
        resolved({.illuminant = 2500, .metersExposure = true}, pictureOf(Colors(9, blue)));
    EXPECT_NEAR(found.curve.exposure, std::log2(0.18 / after), 0.0051);
}

TEST(Metering, LeavesWhatIsGiven) {
    const ToneMapping given{.curve = {.exposure = 2.5}, .illuminant = 4000};
    const ToneMapping found = resolved(given, pictureOf(room(0, 1, 10)));
    EXPECT_EQ(found.curve.exposure, 2.5);
    EXPECT_EQ(found.illuminant, 4000);
    EXPECT_EQ(metered(given, found), "");
}

} // namespace
} // namespace stromboli
