#include "host/core/error.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "tests/film/random_film.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

namespace stromboli {
namespace {

TEST(Png, RoundTrip) {
    const TemporaryFolder folder;
    for (auto [width, height] : {std::pair{1u, 1u}, {7u, 13u}, {640u, 3u}}) {
        ByteImage image(width, height);
        std::mt19937 random(5);
        for (uint8_t& byte : image.rgb)
            byte = static_cast<uint8_t>(random());
        writePng(folder / "a.png", image, PngColorSpace::Srgb);
        const ByteImage back = readPng(folder / "a.png");
        EXPECT_EQ(back.width, width);
        EXPECT_EQ(back.height, height);
        EXPECT_EQ(back.rgb, image.rgb);
    }
    EXPECT_EQ(folder.size(), 1u);
}

TEST(Png, SaysSrgbOnlyForTheSrgbCurve) {
    const TemporaryFolder folder;
    const Film film = randomFilm(2, 2);
    writePicture(folder / "a.png", film, {});
    writePicture(folder / "b.png", film, {{ToneCurve::Kind::Power}});
    EXPECT_THAT(contentOf(folder / "a.png"), testing::HasSubstr("sRGB"));
    for (const char* chunk : {"sRGB", "gAMA", "cHRM", "iCCP"})
        EXPECT_THAT(contentOf(folder / "b.png"), testing::Not(testing::HasSubstr(chunk)));
}

TEST(Png, HoldsTheToneMappedMeans) {
    const TemporaryFolder folder;
    const Film film = randomFilm(5, 4);
    for (const ToneCurve& tone :
         {ToneCurve{}, ToneCurve{ToneCurve::Kind::Srgb, 1.5}, ToneCurve{ToneCurve::Kind::Power}}) {
        writePicture(folder / "a.PNG", film, {tone});
        const ByteImage image = readPng(folder / "a.PNG");
        for (uint32_t y = 0; y < 4; ++y)
            for (uint32_t x = 0; x < 5; ++x)
                for (int c = 0; c < 3; ++c)
                    EXPECT_EQ(image.pixel(x, y)[c], tone.toByte(film.at(x, y).mean[c]));
    }
}

TEST(Exr, RoundTripKeepsEveryFloat) {
    const TemporaryFolder folder;
    FloatImage image(17, 9);
    std::mt19937 random(9);
    std::lognormal_distribution<float> value(0, 20);
    for (const char* name : {"R", "G", "B", "samples", "variance.R"})
        for (float& v : image.channel(name))
            v = value(random);
    image.channel("R")[0] = 1e-45f; // the smallest denormal
    image.channel("G")[0] = 3.402823466e38f;
    writeExr(folder / "a.exr", image);
    const FloatImage back = readExr(folder / "a.exr");
    EXPECT_EQ(back.width, 17u);
    EXPECT_EQ(back.height, 9u);
    EXPECT_EQ(back.channels, image.channels);
}

TEST(Exr, HoldsTheMeansAndOnRequestTheStatistics) {
    const TemporaryFolder folder;
    Film film = randomFilm(5, 4);
    film.at(1, 0).rejected = 2;
    writePicture(folder / "plain.exr", film, {});
    writePicture(folder / "more.exr", film, {.tone = {}, .statistics = true});

    const FloatImage plain = readExr(folder / "plain.exr"), more = readExr(folder / "more.exr");
    EXPECT_EQ(plain.channels.size(), 3u);
    EXPECT_EQ(more.channels.size(), 7u);
    const char* const names[] = {"R", "G", "B"};
    for (size_t i = 0; i < film.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const PixelStatistics& pixel = film.pixels[i];
            EXPECT_EQ(plain.channels.at(names[c])[i], float(pixel.mean[c]));
            EXPECT_EQ(more.channels.at(names[c])[i], float(pixel.mean[c]));
            EXPECT_EQ(more.channels.at(std::string("variance.") + names[c])[i],
                      float(pixel.varianceOfMean()[c]));
        }
    EXPECT_EQ(more.channels.at("samples")[0], 3.0f);
    EXPECT_EQ(more.channels.at("samples")[1], 5.0f);
}

TEST(Exr, AVarianceBeyondFloatBecomesTheLargestFloat) {
    const TemporaryFolder folder;
    Film film(1, 1);
    film.at(0, 0).add({0, 0, 0});
    film.at(0, 0).add({1e30, 1, 1});
    writePicture(folder / "a.exr", film, {.tone = {}, .statistics = true});
    EXPECT_EQ(readExr(folder / "a.exr").channels.at("variance.R")[0], 3.402823466e38f);
}

TEST(PictureFile, CropSaysWhereItLies) {
    const TemporaryFolder folder;
    Film film = randomFilm(4, 3);
    film.area = {8, 6, {3, 2, 4, 3}};
    writePicture(folder / "a.png", film, {});
    writePicture(folder / "a.exr", film, {});
    const ByteImage bytes = readPng(folder / "a.png");
    const FloatImage floats = readExr(folder / "a.exr");
    ASSERT_EQ(bytes.width, 4u);
    ASSERT_EQ(bytes.height, 3u);
    ASSERT_EQ(floats.width, 4u);
    ASSERT_EQ(floats.height, 3u);
    EXPECT_EQ(floats.area.width, 8u);
    EXPECT_EQ(floats.area.height, 6u);
    EXPECT_EQ(floats.area.crop.x, 3u);
    EXPECT_EQ(floats.area.crop.y, 2u);
    for (uint32_t y = 0; y < 3; ++y)
        for (uint32_t x = 0; x < 4; ++x) {
            const glm::dvec3& mean = film.at(x, y).mean;
            EXPECT_EQ(bytes.pixel(x, y)[1], ToneCurve{}.toByte(mean.y));
            EXPECT_EQ(floats.channels.at("G")[y * 4 + x], float(mean.y));
        }
}

TEST(PictureFile, SameFilmSameBytes) {
    const TemporaryFolder folder;
    const Film film = randomFilm(30, 20);
    for (const std::string extension : {".png", ".exr"}) {
        writePicture(folder / ("a" + extension), film, {});
        writePicture(folder / ("b" + extension), film, {});
        EXPECT_EQ(contentOf(folder / ("a" + extension)), contentOf(folder / ("b" + extension)));
    }
}

} // namespace
} // namespace stromboli
