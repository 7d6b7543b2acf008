// What is said of pictures in which little can be seen, and pixels without samples.
#include "host/film/shown_film.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

Film filmOf(uint32_t width, uint32_t height, double radiance) {
    Film film(width, height);
    for (PixelStatistics& p : film.pixels)
        p.add(glm::dvec3(radiance));
    return film;
}

TEST(Brightness, BlackIsUnlit) {
    const Brightness b = brightnessOf(filmOf(4, 4, 0), {});
    EXPECT_TRUE(b.unlit);
    EXPECT_EQ(b.darkShare, 1);
    EXPECT_FALSE(b.exposure);
}

TEST(Brightness, ExposureBringsBrightPixelsToWhite) {
    for (const double radiance : {1e-9, 0.3, 1.0, 4096.0}) {
        const Film film = filmOf(10, 10, radiance);
        const Brightness before = brightnessOf(film, {});
        ASSERT_TRUE(before.exposure);
        EXPECT_NEAR(*before.exposure, -std::log2(radiance), 1e-12);
        EXPECT_EQ(before.whiteShare, radiance > 1 ? 1 : 0);
        EXPECT_EQ(before.darkShare, radiance < 1e-4 ? 1 : 0);
        const Brightness after = brightnessOf(film, {ToneCurve::Kind::Srgb, *before.exposure});
        EXPECT_EQ(after.darkShare, 0);
        EXPECT_EQ(ToneCurve({ToneCurve::Kind::Srgb, *before.exposure}).toByte(radiance), 255);
    }
}

TEST(Brightness, SharesAreOfPixels) {
    Film film = filmOf(4, 2, 0.5);
    film.at(0, 0).mean = {0, 0, 2};
    film.at(1, 0).mean = {0, 0, 0};
    const Brightness b = brightnessOf(film, {});
    EXPECT_EQ(b.whiteShare, 1 / 8.0);
    EXPECT_EQ(b.darkShare, 1 / 8.0);
    EXPECT_FALSE(b.unlit);
}

TEST(Unreached, PixelsShowTheFinestNeighbourThatHasSamples) {
    Film film(16, 8);
    film.at(0, 0).add(glm::dvec3(1));
    film.at(8, 0).add(glm::dvec3(2));
    film.at(4, 4).add(glm::dvec3(3));
    film.at(6, 6).add(glm::dvec3(4));
    EXPECT_EQ(unreachedPixels(film), 124u);
    showNeighbours(film, 8);
    EXPECT_EQ(film.at(7, 1).mean.x, 1);
    EXPECT_EQ(film.at(15, 7).mean.x, 2);
    EXPECT_EQ(film.at(5, 5).mean.x, 3);
    EXPECT_EQ(film.at(7, 7).mean.x, 4);
    EXPECT_EQ(film.at(4, 3).mean.x, 1);
    EXPECT_EQ(unreachedPixels(film), 124u); // they still have none
}

TEST(Unreached, SquaresWithoutSamplesStayBlack) {
    Film film(16, 8);
    film.at(0, 0).add(glm::dvec3(1));
    showNeighbours(film, 8);
    EXPECT_EQ(film.at(8, 0).mean.x, 0);
    EXPECT_EQ(film.at(3, 7).mean.x, 1);
}

} // namespace
} // namespace stromboli
