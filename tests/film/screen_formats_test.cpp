// 16-bit PNG, JPEG and WebP, read back by the decoders of scene/images.
#include "host/core/error.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "scene/images/picture.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>

namespace stromboli {
namespace {

using testing::HasSubstr;

template <class Value>
std::vector<Value> valuesOf(const std::filesystem::path& path) {
    return std::get<std::vector<Value>>(
        images::decodePicture(contentOf(path), path.string()).values);
}

/// Colours that change slowly, as most of a picture does.
ByteImage gradient(uint32_t width, uint32_t height) {
    ByteImage image(width, height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            image.pixel(x, y)[0] = uint8_t(255 * x / width);
            image.pixel(x, y)[1] = uint8_t(255 * y / height);
            image.pixel(x, y)[2] = uint8_t(255 * (x + y) / (width + height));
        }
    return image;
}

ByteImage noise(uint32_t width, uint32_t height, bool hasAlpha) {
    std::mt19937 random(5);
    ByteImage image(width, height);
    for (uint8_t& byte : image.rgb)
        byte = uint8_t(random());
    if (hasAlpha) image.alpha.resize(size_t(width) * height);
    for (uint8_t& byte : image.alpha)
        byte = uint8_t(random());
    if (hasAlpha) image.alpha[0] = 0; // its colour is kept all the same
    return image;
}

/// Root mean square of the differences of colours.
double errorOf(const std::filesystem::path& path, const ByteImage& image) {
    const std::vector<uint8_t> rgba = valuesOf<uint8_t>(path);
    double sum = 0;
    for (size_t i = 0; i < image.rgb.size(); ++i) {
        const double error = double(rgba[i / 3 * 4 + i % 3]) - image.rgb[i];
        sum += error * error;
    }
    return std::sqrt(sum / double(image.rgb.size()));
}

// --- PNG -----------------------------------------------------------------------------------------

TEST(PngOfSixteenBits, RoundTrip) {
    const TemporaryFolder folder;
    std::mt19937 random(5);
    for (const bool hasAlpha : {false, true}) {
        WordImage image(7, 5);
        if (hasAlpha) image.alpha.resize(35);
        for (auto* values : {&image.rgb, &image.alpha})
            for (uint16_t& value : *values)
                value = uint16_t(random());
        writePng(folder / "a.png", image, PngColorSpace::Srgb, {{"Scene", "x"}});
        const std::vector<uint16_t> back = valuesOf<uint16_t>(folder / "a.png");
        for (size_t i = 0; i < 35; ++i) {
            for (size_t c = 0; c < 3; ++c)
                EXPECT_EQ(back[4 * i + c], image.rgb[3 * i + c]);
            EXPECT_EQ(back[4 * i + 3], hasAlpha ? image.alpha[i] : 65535);
        }
        EXPECT_EQ(readPngNotes(folder / "a.png"), (PictureNotes{{"Scene", "x"}}));
    }
}

TEST(PngOfSixteenBits, HoldsMoreThanBytes) {
    const TemporaryFolder folder;
    FloatImage radiance(2, 1);
    for (const char* name : kColorChannels)
        radiance.channel(name) = {0.5f, 0.5005f};
    PictureOptions options;
    options.encoding.bits = 16;
    writeToneMapped(folder / "a.png", radiance, options);
    const std::vector<uint16_t> values = valuesOf<uint16_t>(folder / "a.png");
    EXPECT_NEAR(values[0], 65535 * srgbFromLinear(0.5f), 0.5);
    EXPECT_GT(values[4], values[0]);
}

// --- JPEG ----------------------------------------------------------------------------------------

/// A gradient is of low frequencies alone, whose steps are 1 or 2 at this quality (Annex K of ITU-T
/// T.81, a tenth of its tables): the few that there are are off by 1 at most.
TEST(Jpeg, OfAGradientIsNear) {
    const TemporaryFolder folder;
    const ByteImage image = gradient(99, 61);
    writeJpeg(folder / "a.jpg", image, 95);
    EXPECT_LT(errorOf(folder / "a.jpg", image), 2);
    const images::Picture back = images::decodePicture(contentOf(folder / "a.jpg"), "a.jpg");
    EXPECT_EQ(back.width, 99u);
    EXPECT_EQ(back.height, 61u);
}

TEST(Jpeg, QualityIsErrorAgainstSize) {
    const TemporaryFolder folder;
    const ByteImage image = noise(64, 64, false);
    double error = 256;
    uintmax_t size = 0;
    for (const uint32_t quality : {10u, 50u, 95u, 100u}) {
        writeJpeg(folder / "a.jpg", image, quality);
        EXPECT_LT(errorOf(folder / "a.jpg", image), error);
        EXPECT_GT(std::filesystem::file_size(folder / "a.jpg"), size);
        error = errorOf(folder / "a.jpg", image);
        size = std::filesystem::file_size(folder / "a.jpg");
    }
    EXPECT_LT(error, 2); // what is left is the rounding of colours to luma and chroma
}

/// Red and blue columns by turns: with one colour for two columns all would be purple, an error of
/// more than 80.
TEST(Jpeg, HasColoursForEachPixel) {
    const TemporaryFolder folder;
    ByteImage image(32, 32);
    for (uint32_t y = 0; y < 32; ++y)
        for (uint32_t x = 0; x < 32; ++x)
            image.pixel(x, y)[x % 2 == 0 ? 0 : 2] = 255;
    writeJpeg(folder / "a.jpg", image, 95);
    EXPECT_LT(errorOf(folder / "a.jpg", image), 10);
}

TEST(Jpeg, ALongNoteIsCut) {
    const TemporaryFolder folder;
    writeJpeg(folder / "a.jpg", gradient(8, 8), 95, {{"Command", std::string(100'000, 'x')}});
    const PictureNotes notes = readJpegNotes(folder / "a.jpg");
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].text, std::string(65533 - std::string("Command: ").size(), 'x'));
}

// --- WebP ----------------------------------------------------------------------------------------

/// VP8 works on 8 bits of luma and chroma with colours for every other pixel: three levels are what
/// it loses of a gradient at its best.
TEST(WebP, OfAGradientIsNear) {
    const TemporaryFolder folder;
    const ByteImage image = gradient(99, 61);
    writeWebP(folder / "a.webp", image, 95);
    EXPECT_LT(errorOf(folder / "a.webp", image), 3);
}

TEST(WebP, OfQuality100IsWithoutLoss) {
    const TemporaryFolder folder;
    for (const bool hasAlpha : {false, true}) {
        const ByteImage image = noise(31, 17, hasAlpha);
        writeWebP(folder / "a.webp", image, 100);
        EXPECT_EQ(errorOf(folder / "a.webp", image), 0);
        const std::vector<uint8_t> rgba = valuesOf<uint8_t>(folder / "a.webp");
        for (size_t i = 0; i < size_t(31) * 17; ++i)
            EXPECT_EQ(rgba[4 * i + 3], hasAlpha ? image.alpha[i] : 255);
    }
}

/// Alpha is kept beside the colours, also where these lose something.
TEST(WebP, AlphaIsExact) {
    const TemporaryFolder folder;
    const ByteImage image = noise(31, 17, true);
    for (const PictureNotes& notes : {PictureNotes{}, PictureNotes{{"Scene", "x"}}}) {
        writeWebP(folder / "a.webp", image, 90, notes);
        const std::vector<uint8_t> rgba = valuesOf<uint8_t>(folder / "a.webp");
        for (size_t i = 0; i < image.alpha.size(); ++i)
            EXPECT_EQ(rgba[4 * i + 3], image.alpha[i]);
    }
}

// --- Both ----------------------------------------------------------------------------------------

TEST(LossyFormats, NotesComeBackAndChangeNoPixel) {
    const TemporaryFolder folder;
    const PictureNotes notes = {{"Software", "Stromboli 1.2.3"},
                                {"Scene", "M\xc3\xb6we \xe2\x82\xac.dae"},
                                {"Command", "stromboli render 'a <b> & c: &lt;d.dae' --strict"},
                                {"Empty", ""}};
    Film film(9, 7);
    for (size_t i = 0; i < film.pixels.size(); ++i)
        film.pixels[i].mean = glm::dvec3(0.01 * double(i));
    for (const std::string extension : {".jpg", ".jpeg", ".webp", ".WebP"}) {
        PictureFile file(folder / ("a" + extension), film.area, {});
        file.place(film);
        file.write(notes);
        writePicture(folder / ("b" + extension), film, {});
        EXPECT_EQ(readPictureNotes(folder / ("a" + extension)), notes) << extension;
        EXPECT_TRUE(readPictureNotes(folder / ("b" + extension)).empty()) << extension;
        EXPECT_EQ(valuesOf<uint8_t>(folder / ("a" + extension)),
                  valuesOf<uint8_t>(folder / ("b" + extension)));
    }
}

TEST(LossyFormats, OfWhatIsNoPictureHaveNoNotes) {
    const TemporaryFolder folder;
    for (const char* name : {"a.jpg", "a.webp"}) {
        EXPECT_THROW(readPictureNotes(folder / name), UsageError);
        std::ofstream(folder / name) << "no picture";
        EXPECT_THROW(readPictureNotes(folder / name), UsageError);
    }
}

TEST(LossyFormats, TooManyPixelsAreRefused) {
    EXPECT_THAT(test::refusalOf([] { checkPictureSize("a.webp", 16384, 4); }),
                HasSubstr("WebP holds at most 16383 a side"));
    EXPECT_THAT(test::refusalOf([] { checkPictureSize("a.jpg", 4, 65501); }),
                HasSubstr("JPEG holds at most 65500 a side"));
    for (const char* name : {"a.png", "a.exr", "-"})
        checkPictureSize(name, 65536, 65536);
    checkPictureSize("a.jpg", 65500, 65500);
    checkPictureSize("a.webp", 16383, 16383);
}

TEST(LossyFormats, TheLargestFileIsKeptByNoise) {
    const TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair(1u, 1u), {200u, 100u}, {1u, 900u}})
        for (const char* name : {"a.jpg", "a.webp"}) {
            const ByteImage image = noise(width, height, std::string(name) == "a.webp");
            if (std::string(name) == "a.jpg")
                writeJpeg(folder / name, image, 100);
            else
                writeWebP(folder / name, image, 100);
            EXPECT_LE(std::filesystem::file_size(folder / name),
                      largestPictureFile(folder / name, width, height, {}));
        }
}

TEST(ScreenFormats, NamesTellThem) {
    EXPECT_EQ(formatOf("A.JPG"), PictureFormat::Jpeg);
    EXPECT_EQ(formatOf("a.jpeg"), PictureFormat::Jpeg);
    EXPECT_EQ(formatOf("a.WebP"), PictureFormat::WebP);
    EXPECT_EQ(formatOf("-"), PictureFormat::Png);
    EXPECT_FALSE(isToneMapped("a.exr"));
    EXPECT_THAT(test::refusalOf([] { formatOf("a.gif"); }),
                HasSubstr("must end in .png, .exr, .jpg, .jpeg or .webp"));
}

} // namespace
} // namespace stromboli
