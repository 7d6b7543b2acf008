#include "host/compare/metrics.hpp"
#include "host/core/error.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "tests/compare/pictures.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

namespace stromboli::compare {
namespace {

FloatImage floats(const Picture& picture) {
    FloatImage image(picture.width, picture.height);
    const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
        for (size_t i = 0; i < picture.rgb.size(); ++i)
            image.channel(names[c])[i] = float(picture.rgb[i][c]);
    return image;
}

TEST(Pfm, RoundTripKeepsEveryFloat) {
    const TemporaryFolder folder;
    const FloatImage image = floats(randomPicture(7, 5, 1));
    writePfm(folder / "a.pfm", image);
    EXPECT_EQ(readPfm(folder / "a.pfm").channels, image.channels);
}

TEST(Pfm, RowsFromBelowEitherByteOrderGrey) {
    const TemporaryFolder folder;
    // 1.0f is 3F 80 00 00, 2.0f is 40 00 00 00, the most significant byte first.
    std::ofstream(folder / "big.pfm", std::ios::binary) << "Pf\n1 2\n1.0\n"
                                                        << std::string("\x3F\x80\0\0\x40\0\0\0", 8);
    std::ofstream(folder / "little.pfm", std::ios::binary)
        << "Pf 1 2 -1\n"
        << std::string("\0\0\x80\x3F\0\0\0\x40", 8);
    for (const char* name : {"big.pfm", "little.pfm"}) {
        const FloatImage image = readPfm(folder / name);
        EXPECT_EQ(image.height, 2u);
        for (const char* channel : {"R", "G", "B"})
            EXPECT_EQ(image.channels.at(channel), (std::vector<float>{2, 1})) << name;
    }
}

TEST(Pfm, DamagedFilesAreRefused) {
    const TemporaryFolder folder;
    for (const std::string content :
         {"", "P6\n1 1\n255\nabc", "PF\n2 2\n-1.0\nshort", "PF\n0 2\n-1\n", "PF\n2\n",
          "PF\n99999999 99999999\n-1\n", "PF\n1 1\n0\n............"}) {
        std::ofstream(folder / "a.pfm", std::ios::binary) << content;
        EXPECT_THROW(readPfm(folder / "a.pfm"), UsageError) << content;
    }
    EXPECT_THROW(readPfm(folder / "none.pfm"), UsageError);
}

TEST(ReadPicture, EveryKindGivesLinearValues) {
    const TemporaryFolder folder;
    const Picture p = randomPicture(6, 4, 2);
    writeExr(folder / "a.exr", floats(p));
    writePfm(folder / "a.PFM", floats(p));
    ByteImage bytes(6, 4);
    for (size_t i = 0; i < bytes.rgb.size(); ++i)
        bytes.rgb[i] = uint8_t(i * 3);
    writePng(folder / "a.png", bytes, PngColorSpace::Srgb);
    for (const char* name : {"a.exr", "a.PFM"}) {
        const Picture read = readPicture(folder / name);
        EXPECT_FALSE(read.lowDynamicRange);
        EXPECT_FALSE(read.film);
        for (size_t i = 0; i < p.rgb.size(); ++i)
            EXPECT_EQ(read.rgb[i].y, double(float(p.rgb[i].y)));
    }
    const Picture png = readPicture(folder / "a.png");
    EXPECT_TRUE(png.lowDynamicRange);
    EXPECT_DOUBLE_EQ(png.rgb[5].z, linearFromSrgb(bytes.rgb[17] / 255.0));
}

/// A WebP without loss is what a PNG of these bytes is, and a good JPEG is near it.
TEST(ReadPicture, KindsThatLoadersRead) {
    const TemporaryFolder folder;
    ByteImage bytes(16, 8);
    for (size_t i = 0; i < bytes.rgb.size(); ++i)
        bytes.rgb[i] = uint8_t(100 + i / 3);
    writePng(folder / "a.png", bytes, PngColorSpace::Srgb);
    writeWebP(folder / "a.webp", bytes, 100);
    writeJpeg(folder / "a.jpg", bytes, 100);
    std::ofstream(folder / "a.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"
                                    << "\x80\x40\x20\x82";
    const Picture png = readPicture(folder / "a.png");
    const Picture webp = readPicture(folder / "a.webp"), jpeg = readPicture(folder / "a.jpg");
    EXPECT_TRUE(webp.lowDynamicRange && jpeg.lowDynamicRange);
    for (size_t i = 0; i < png.rgb.size(); ++i) {
        EXPECT_NEAR(webp.rgb[i].x, png.rgb[i].x, 1e-6);
        EXPECT_NEAR(jpeg.rgb[i].x, png.rgb[i].x, 0.02);
    }
    const Picture hdr = readPicture(folder / "a.hdr");
    EXPECT_FALSE(hdr.lowDynamicRange);
    EXPECT_NEAR(hdr.rgb[0].x, 2, 0.02); // 128 / 256 * 2^2
    EXPECT_NEAR(hdr.rgb[0].z, 0.5, 0.02);
}

/// Loaders show a part of a picture; a comparison with it would mean nothing.
TEST(ReadPicture, APartOfAPictureIsRefused) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n"
                                    << "\x80\x40\x20\x82\x80";
    EXPECT_THAT(test::refusalOf([&] { readPicture(folder / "a.hdr"); }),
                testing::HasSubstr("the file is truncated: expected a whole picture"));
}

TEST(ReadPicture, StatisticsComeBackAsAFilm) {
    const TemporaryFolder folder;
    Film film(2, 1);
    film.at(0, 0).add({1, 2, 3});
    film.at(0, 0).add({3, 2, 1});
    film.at(0, 0).add({2, 5, 8});
    film.at(1, 0).add({1, 1, 1});
    writePicture(folder / "a.exr", film, {.tone = {}, .statistics = true});
    const Picture read = readPicture(folder / "a.exr");
    ASSERT_TRUE(read.film);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read.film->pixels[i].count, film.pixels[i].count);
        for (int c = 0; c < 3; ++c)
            EXPECT_FLOAT_EQ(float(read.film->pixels[i].m2[c]), float(film.pixels[i].m2[c]));
    }
}

TEST(ReadPicture, WhatCannotBeReadIsRefused) {
    const TemporaryFolder folder;
    FloatImage grey(2, 2);
    grey.channel("Y");
    writeExr(folder / "grey.exr", grey);
    for (const char* name : {"grey.exr", "none.exr", "none.png", "a.jpg", "a"})
        EXPECT_THROW(readPicture(folder / name), UsageError) << name;
}

TEST(ReadPicture, StatisticsThatAreNoneAreRefused) {
    const TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const auto& [channel, value] : {std::pair("samples", nan),
                                         {"samples", 1e10f},
                                         {"samples", -1.0f},
                                         {"variance.G", nan},
                                         {"variance.B", -1.0f},
                                         {"variance.R", std::numeric_limits<float>::infinity()}}) {
        Film film(2, 1);
        FloatImage image = linearPicture(film, true);
        image.channel(channel)[1] = value;
        writeExr(folder / "a.exr", image);
        EXPECT_THROW(readPicture(folder / "a.exr"), UsageError) << channel << " " << value;
    }
}

TEST(ReadPicture, CountsPixelsThatAreNotFinite) {
    Picture p = constantPicture(3, 1, glm::dvec3(1));
    p.rgb[0].y = std::numeric_limits<double>::quiet_NaN();
    p.rgb[2] = glm::dvec3(std::numeric_limits<double>::infinity());
    EXPECT_EQ(countNotFinite(p), 2u);
}

} // namespace
} // namespace stromboli::compare
