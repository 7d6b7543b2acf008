// From radiance to numbers of 8 and 16 bits: order of the steps, rounding, dithering.
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "host/film/white_balance.hpp"
#include "tests/film/random_film.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace stromboli {
namespace {

FloatImage flat(const PictureArea& area, const glm::vec3& color) {
    FloatImage image(area);
    for (int c = 0; c < 3; ++c)
        std::ranges::fill(image.channel(kColorChannels[c]), color[c]);
    return image;
}

FloatImage randomRadiance(uint32_t width, uint32_t height) {
    std::mt19937_64 random(7);
    std::lognormal_distribution<float> radiance(-1, 2);
    FloatImage image(width, height);
    for (const char* name : kColorChannels)
        for (float& value : image.channel(name))
            value = radiance(random);
    return image;
}

/// What renders without these options show, to the byte.
TEST(ToneMapping, OfTheCurveAloneIsTheCurve) {
    const FloatImage radiance = randomRadiance(64, 16);
    for (const ToneCurve& curve :
         {ToneCurve{}, ToneCurve{ToneCurve::Kind::Srgb, -1.3}, ToneCurve{ToneCurve::Kind::Power}}) {
        const ByteImage image = toneMap<uint8_t>(radiance, {curve}, false);
        for (size_t i = 0; i < 64 * 16; ++i)
            for (size_t c = 0; c < 3; ++c)
                EXPECT_EQ(image.rgb[3 * i + c],
                          curve.toByte(radiance.channels.at(kColorChannels[c])[i]));
    }
}

/// Light of 3200 K, of a quarter of white, two stops up, is white, and no other order makes it so.
TEST(ToneMapping, BalancesThenExposes) {
    const glm::dvec3 lamp = glm::inverse(whiteBalance(3200)) * glm::dvec3(0.25);
    const ToneMapping tone{.curve = {.exposure = 2}, .illuminant = 3200};
    const glm::dvec3 signals = SignalOfRadiance(tone)(lamp);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(signals[c], 1, 1e-9);
    EXPECT_LT(SignalOfRadiance({.curve = {.exposure = 2}})(lamp).z, 0.9);
}

TEST(ToneMapping, ShowsTheViewOfTheExposedRadiance) {
    const glm::dvec3 radiance(0.4, 0.1, 0.05);
    for (const View view : {View::AgX, View::Filmic, View::PbrNeutral}) {
        const glm::dvec3 light = displayLight(view, 2.0 * radiance);
        const glm::dvec3 signals =
            SignalOfRadiance({.curve = {.exposure = 1}, .view = view})(radiance);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(signals[c], srgbFromLinear(light[c]), 1e-12);
    }
}

TEST(ToneMapping, OfSixteenBitsIsTheNearestToo) {
    const FloatImage radiance = randomRadiance(64, 16);
    const WordImage image = toneMap<uint16_t>(radiance, {}, false);
    for (size_t i = 0; i < 64 * 16; ++i)
        for (size_t c = 0; c < 3; ++c)
            EXPECT_LE(std::fabs(image.rgb[3 * i + c] -
                                65535 * srgbFromLinear(radiance.channels.at(kColorChannels[c])[i])),
                      0.5 + 1e-9);
}

/// Colours are divided by alpha, which pixel filters bring below 0 and above 1.
TEST(ToneMapping, DividesByAlpha) {
    FloatImage radiance = flat({4, 1, {}}, glm::vec3(0.5f));
    radiance.channel(kAlphaChannel) = {-0.2f, 1.2f, 0.5f, 0};
    const ByteImage image = toneMap<uint8_t>(radiance, {}, false);
    EXPECT_EQ(image.alpha, (std::vector<uint8_t>{0, 255, 128, 0}));
    const ToneCurve curve;
    EXPECT_EQ(image.pixel(0, 0)[0], 0);
    EXPECT_EQ(image.pixel(1, 0)[0], curve.toByte(0.5));
    EXPECT_EQ(image.pixel(2, 0)[0], 255);
    EXPECT_EQ(toneMap<uint16_t>(radiance, {}, false).alpha,
              (std::vector<uint16_t>{0, 65535, 32768, 0}));
}

// --- Dithering -----------------------------------------------------------------------------------

/// Radiance whose signal is `level` of 255.
float radianceOf(double level) {
    return float(linearFromSrgb(level / 255));
}

double meanOf(const ByteImage& image) {
    double sum = 0;
    for (const uint8_t byte : image.rgb)
        sum += byte;
    return sum / double(image.rgb.size());
}

/// On 4096 pixels the lattice's share below any threshold is off by less than 0.4 % (its
/// discrepancy is of the order of log N / N).
TEST(Dithering, OnTheMeanIsTheSignal) {
    for (double level = 0; level <= 255; level += 0.21) {
        const double mean =
            meanOf(toneMap<uint8_t>(flat({64, 64, {}}, glm::vec3(radianceOf(level))), {}, true));
        EXPECT_NEAR(mean, level, 0.004) << level;
    }
}

/// Whole levels stay as they are: black and white have no specks.
TEST(Dithering, IsOfTheNumbersOnEitherSideAlone) {
    for (const double level : {0.0, 100.5, 254.9, 255.0}) {
        const ByteImage image =
            toneMap<uint8_t>(flat({64, 64, {}}, glm::vec3(radianceOf(level))), {}, true);
        const auto [least, most] = std::ranges::minmax(image.rgb);
        EXPECT_EQ(least, int(std::floor(level)));
        EXPECT_EQ(most, int(std::ceil(level)));
    }
    EXPECT_EQ(meanOf(toneMap<uint8_t>(flat({9, 9, {}}, glm::vec3(50)), {}, true)), 255);
}

/// The three channels of grey are rounded alike.
TEST(Dithering, GreyStaysGrey) {
    const ByteImage image =
        toneMap<uint8_t>(flat({32, 32, {}}, glm::vec3(radianceOf(77.3))), {}, true);
    for (size_t i = 0; i < image.rgb.size(); i += 3) {
        EXPECT_EQ(image.rgb[i], image.rgb[i + 1]);
        EXPECT_EQ(image.rgb[i], image.rgb[i + 2]);
    }
}

/// By a pixel's place in the whole picture and nothing else: a part has the bytes that it has
/// there.
TEST(Dithering, DependsOnThePixelAlone) {
    const FloatImage whole = randomRadiance(40, 30);
    const ByteImage all = toneMap<uint8_t>(whole, {}, true);
    EXPECT_EQ(all.rgb, toneMap<uint8_t>(whole, {}, true).rgb);
    FloatImage part(PictureArea{40, 30, {7, 5, 11, 13}});
    for (const char* name : kColorChannels)
        for (uint32_t i = 0; i < 11 * 13; ++i) {
            const PixelPlace place = part.area.placeOf(i);
            part.channel(name)[i] = whole.channels.at(name)[place.y * 40 + place.x];
        }
    const ByteImage bytes = toneMap<uint8_t>(part, {}, true);
    for (uint32_t y = 0; y < 13; ++y)
        for (uint32_t x = 0; x < 11; ++x)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(bytes.pixel(x, y)[c], all.pixel(x + 7, y + 5)[c]);
}

// --- Files of films ------------------------------------------------------------------------------

PictureOptions optionsOf(const ToneMapping& tone, const PictureEncoding& encoding = {}) {
    PictureOptions options;
    options.tone = tone;
    options.encoding = encoding;
    return options;
}

/// A picture in bands is metered as a whole, and made as one from an EXR file is.
TEST(ToneMappedFile, IsThatOfTheRadianceInAnExrFile) {
    const TemporaryFolder folder;
    const Film film = randomFilm(24, 20);
    writePicture(folder / "a.exr", film, {});
    const FloatImage radiance = readExr(folder / "a.exr");
    for (const PictureOptions& options :
         {optionsOf({.view = View::AgX}), optionsOf({.metersExposure = true}),
          optionsOf({.metersExposure = true, .metersIlluminant = true}),
          optionsOf({}, {.dithers = true})}) {
        PictureFile file(folder / "bands.png", film.area, options);
        for (const uint32_t top : {0u, 8u, 16u}) {
            Film band(PictureArea{24, 20, {0, top, 24, std::min(8u, 20 - top)}});
            std::copy_n(film.pixels.begin() + 24 * top, band.pixels.size(), band.pixels.begin());
            file.place(band);
        }
        const ToneMapping inBands = file.write();
        const ToneMapping later = writeToneMapped(folder / "later.png", radiance, options);
        EXPECT_EQ(readPng(folder / "bands.png").rgb, readPng(folder / "later.png").rgb);
        EXPECT_FALSE(inBands.isOpen());
        EXPECT_EQ(inBands.curve.exposure, later.curve.exposure);
        EXPECT_EQ(inBands.illuminant, later.illuminant);
        EXPECT_EQ(inBands.curve.exposure != 0, options.tone.metersExposure);
    }
}

/// What a message says was found out makes the same picture when it is given.
TEST(ToneMappedFile, IsTheSameByWhatWasFoundOut) {
    const TemporaryFolder folder;
    const Film film = randomFilm(24, 20);
    const PictureOptions open = optionsOf({.metersExposure = true, .metersIlluminant = true});
    PictureFile file(folder / "a.png", film.area, open);
    file.place(film);
    writePicture(folder / "b.png", film, optionsOf(file.write()));
    EXPECT_EQ(readPng(folder / "a.png").rgb, readPng(folder / "b.png").rgb);
}

} // namespace
} // namespace stromboli
