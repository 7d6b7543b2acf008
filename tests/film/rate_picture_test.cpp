#include "host/core/error.hpp"
#include "host/film/shown_film.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace stromboli {
namespace {

using Colour = std::array<int, 3>;

/// The colour of a pixel that took `taken` of `maximum` samples.
Colour rateColour(uint32_t taken, uint32_t maximum) {
    Film film(1, 1);
    for (uint32_t i = 0; i < taken; ++i)
        film.at(0, 0).add({1, 1, 1});
    const ByteImage image = ratePicture(film, maximum);
    return {image.rgb[0], image.rgb[1], image.rgb[2]};
}

TEST(RatePicture, RunsFromBlueThroughGreenToRed) {
    EXPECT_EQ(rateColour(0, 64), (Colour{0, 0, 255}));
    EXPECT_EQ(rateColour(16, 64), (Colour{0, 127, 127}));
    EXPECT_EQ(rateColour(32, 64), (Colour{0, 255, 0}));
    EXPECT_EQ(rateColour(48, 64), (Colour{127, 127, 0}));
    EXPECT_EQ(rateColour(64, 64), (Colour{255, 0, 0}));
}

TEST(RatePicture, TruncatesAndNeverRounds) {
    EXPECT_EQ(rateColour(1, 3), (Colour{0, 170, 85}));
    EXPECT_EQ(rateColour(3, 10), (Colour{0, 153, 102}));
    EXPECT_EQ(rateColour(1, 1000), (Colour{0, 0, 254})); // 0.51, 254.49
}

TEST(RatePicture, CountsRejectedSamplesAndClampsAboveTheMaximum) {
    Film film(1, 1);
    film.at(0, 0).rejected = 4;
    EXPECT_THAT(ratePicture(film, 8).rgb, testing::ElementsAre(0, 255, 0));
    EXPECT_THAT(ratePicture(film, 2).rgb, testing::ElementsAre(255, 0, 0));
    EXPECT_THAT(ratePicture(film, 0).rgb, testing::ElementsAre(255, 0, 0));
}

TEST(RatePicture, IsOfTheSizeOfTheFilm) {
    Film film(PictureArea{3, 2, {1, 1, 2, 1}});
    film.at(1, 0).count = 1;
    const ByteImage image = ratePicture(film, 1);
    EXPECT_EQ(image.width, 2u);
    EXPECT_EQ(image.height, 1u);
    EXPECT_THAT(image.rgb, testing::ElementsAre(0, 0, 255, 255, 0, 0));
}

TEST(RatePicture, GoesBesideThePicture) {
    EXPECT_EQ(ratePicturePath("out/a.b.png"), "out/a.b_rate.png");
    EXPECT_EQ(ratePicturePath("a.exr"), "a_rate.png");
}

} // namespace
} // namespace stromboli
