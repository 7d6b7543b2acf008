// Pictures that libraries encode, and ones written byte by byte, have the pixels they were given.

#include "host/core/error.hpp"
#include "scene/images/exr_channels.hpp"
#include "scene/images/float_image.hpp"
#include "scene/images/picture.hpp"
#include "tests/scene/images/encoders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>

namespace stromboli::images {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::FloatEq;
using testing::HasSubstr;
using Bytes = std::vector<uint8_t>;
using Words = std::vector<uint16_t>;
using Floats = std::vector<float>;

template <class Values>
Values valuesOf(const std::string& bytes) {
    return std::get<Values>(decodePicture(bytes, "picture").values);
}

TEST(Formats, PngOfEightBits) {
    EXPECT_THAT(valuesOf<Bytes>(test::png8(2, 1, 3, {1, 2, 3, 250, 251, 252})),
                ElementsAre(1, 2, 3, 255, 250, 251, 252, 255));
    EXPECT_THAT(valuesOf<Bytes>(test::png8(1, 2, 4, {1, 2, 3, 4, 5, 6, 7, 8})),
                ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
    EXPECT_THAT(valuesOf<Bytes>(test::png8(2, 1, 1, {7, 200})),
                ElementsAre(7, 7, 7, 255, 200, 200, 200, 255));
    EXPECT_THAT(valuesOf<Bytes>(test::png8(1, 1, 2, {9, 10})), ElementsAre(9, 9, 9, 10));
}

/// Rows that are there are shown, and what is missing is mid grey.
TEST(Formats, PngThatEndsTooEarlyIsShownAsFarAsItGoes) {
    Bytes noise(64 * 64 * 3);
    uint32_t random = 1;
    for (uint8_t& value : noise)
        value = uint8_t((random = random * 1664525u + 1013904223u) >> 24);
    const std::string whole = test::png8(64, 64, 3, noise);
    for (const size_t cut : {whole.size() / 2, size_t(12)}) { // the last chunk has twelve bytes
        const Picture picture = decodePicture(whole.substr(0, whole.size() - cut), "picture");
        const auto& values = std::get<Bytes>(picture.values);
        EXPECT_EQ(values.at(0), noise[0]);
        EXPECT_EQ(values.at(63 * 64 * 4), cut > 12 ? 127 : noise[63 * 64 * 3]);
        EXPECT_EQ(values.at(63 * 64 * 4 + 3), 255);
        ASSERT_EQ(picture.faults.size(), 1u);
        EXPECT_EQ(picture.faults[0].kind, build::Shortfall::PicturePart);
    }
}

/// Other programs do not look at checksums.
TEST(Formats, PngOfWrongChecksumsIsShown) {
    const std::string whole = test::png8(1, 1, 3, {1, 2, 3});
    const size_t header = 8 + 8 + 13, data = whole.find("IEND") - 8;
    for (const size_t checksum : {header, data}) {
        std::string damaged = whole;
        damaged[checksum] = char(damaged[checksum] ^ 1);
        const Picture picture = decodePicture(damaged, "picture");
        EXPECT_THAT(std::get<Bytes>(picture.values), ElementsAre(1, 2, 3, 255));
        ASSERT_EQ(picture.faults.size(), 1u);
        EXPECT_THAT(picture.faults[0].problem, testing::HasSubstr("CRC error"));
    }
}

TEST(Formats, PngOfSixteenBits) {
    EXPECT_THAT(valuesOf<Words>(test::png16(1, 1, 3, {1, 256, 65535})),
                ElementsAre(1, 256, 65535, 65535));
    EXPECT_THAT(valuesOf<Words>(test::png16(1, 1, 2, {258, 3})), ElementsAre(258, 258, 258, 3));
}

TEST(Formats, JpegOfColourAndGrey) {
    // A quantisation step of 1 and rounding in two transforms leave an error of a few steps.
    const Bytes colour = valuesOf<Bytes>(test::jpeg(8, 8, 3, Bytes(8 * 8 * 3, 100)));
    ASSERT_EQ(colour.size(), 8u * 8 * 4);
    EXPECT_NEAR(colour[0], 100, 2);
    EXPECT_EQ(colour[3], 255);
    const Bytes grey = valuesOf<Bytes>(test::jpeg(3, 5, 1, Bytes(15, 50)));
    ASSERT_EQ(grey.size(), 15u * 4);
    EXPECT_NEAR(grey[0], 50, 1);
    EXPECT_EQ(grey[0], grey[1]);
}

TEST(Formats, Webp) {
    EXPECT_THAT(valuesOf<Bytes>(test::webp(2, 1, {1, 2, 3, 255, 250, 251, 252, 128})),
                ElementsAre(1, 2, 3, 255, 250, 251, 252, 128));
}

/// Rows that are there are shown, and what is missing is mid grey.
TEST(Formats, WebpThatEndsTooEarlyIsShownAsFarAsItGoes) {
    Bytes noise(64 * 64 * 4, 255);
    uint32_t random = 1;
    for (size_t i = 0; i < noise.size(); ++i)
        if (i % 4 < 3) noise[i] = uint8_t((random = random * 1664525u + 1013904223u) >> 24);
    const std::string whole = test::webp(64, 64, noise);
    const Picture picture = decodePicture(whole.substr(0, whole.size() / 2), "picture");
    const auto& values = std::get<Bytes>(picture.values);
    EXPECT_EQ(Bytes(values.begin(), values.begin() + 64 * 4),
              Bytes(noise.begin(), noise.begin() + 64 * 4));
    EXPECT_THAT(Bytes(values.end() - 4, values.end()), ElementsAre(127, 127, 127, 255));
    ASSERT_EQ(picture.faults.size(), 1u);
    EXPECT_EQ(picture.faults[0].kind, build::Shortfall::PicturePart);
}

/// Three columns and nine rows, as Pillow writes them: colour (x + y) % 3, of which the last is
/// none.
std::string gif(char flags = 0) {
    std::string bytes("GIF89a\x03\x00\x09\x00\x81\x00\x00\x0a\x14\x1e\xc8\x64\x32\x00\x00\xff\x07"
                      "\x07\x07\x21\xf9\x04"
                      "\x01\x00\x00\x02\x00\x2c\x00\x00\x00\x00\x03\x00\x09\x00\x00\x08\x14\x00\x01"
                      "\x04\x10\x30\x10\x80"
                      "\x00\x81\x02\x09\x1e\x3c\x18\x20\x61\x41\x86\x01\x01\x00\x3b",
                      67);
    bytes[42] = flags;
    return bytes;
}

TEST(Formats, Gif) {
    const std::array<Bytes, 3> colors = {Bytes{10, 20, 30, 255}, {200, 100, 50, 255}, {0, 0, 0, 0}};
    const std::array<size_t, 9> inOrder = {0, 1, 2, 3, 4, 5, 6, 7, 8},
                                interlaced = {0, 8, 4, 2, 6, 1, 3, 5, 7};
    for (const bool isInterlaced : {false, true}) {
        const Bytes values = valuesOf<Bytes>(gif(isInterlaced ? 0x40 : 0));
        ASSERT_EQ(values.size(), 3u * 9 * 4);
        for (size_t row = 0; row < 9; ++row) // as they come in the file
            for (size_t x = 0; x < 3; ++x) {
                const size_t y = (isInterlaced ? interlaced : inOrder)[row];
                const auto texel = values.begin() + std::ptrdiff_t(4 * (3 * y + x));
                EXPECT_EQ(Bytes(texel, texel + 4), colors[(x + row) % 3]) << x << ' ' << y;
            }
    }
}

TEST(Formats, GifThatEndsTooEarlyIsShownAsFarAsItGoes) {
    const Picture picture = decodePicture(gif().substr(0, 58), "picture"); // within the first block
    EXPECT_EQ(std::get<Bytes>(picture.values), Bytes(3 * 9 * 4, 0));
    ASSERT_EQ(picture.faults.size(), 1u);
    EXPECT_EQ(picture.faults[0].kind, build::Shortfall::PicturePart);
}

TEST(Formats, OpenExr) {
    EXPECT_THAT(valuesOf<Floats>(test::exr(1, 2, "RGB", {1, 2, 3, 0.5f, 1e30f, -1}, false)),
                ElementsAre(1, 2, 3, 1, 0.5f, 1e30f, -1, 1));
    EXPECT_THAT(valuesOf<Floats>(test::exr(1, 1, "RGBA", {1, 2, 3, 0.25f}, true)),
                ElementsAre(1, 2, 3, 0.25f));
    EXPECT_THAT(valuesOf<Floats>(test::exr(2, 1, "Y", {7, 9}, false)),
                ElementsAre(7, 7, 7, 1, 9, 9, 9, 1));
}

TEST(Formats, PfmFromTheBottomUp) {
    const std::string one("\x00\x00\x80\x3f", 4), two("\x00\x00\x00\x40", 4);
    EXPECT_THAT(valuesOf<Floats>("PF\n1 2\n-1.0\n" + one + one + two + two + two + one),
                ElementsAre(2, 2, 1, 1, 1, 1, 2, 1));
    const std::string bigOne("\x3f\x80\x00\x00", 4);
    EXPECT_THAT(valuesOf<Floats>("Pf 1 1 1\n" + bigOne), ElementsAre(1, 1, 1, 1));
    EXPECT_THAT(valuesOf<Floats>("PF4\n1 1\n-1.0\n" + one + two + one + two),
                ElementsAre(1, 2, 1, 2));
    EXPECT_THROW(valuesOf<Floats>("PF9\n1 1\n-1\n" + one + one + one), SceneError);
    EXPECT_THROW(valuesOf<Floats>("PF\n9 9\n-1\n" + one), SceneError);
    EXPECT_THROW(valuesOf<Floats>("PF\nx 9\n-1\n" + one), SceneError);
}

/// The header of a Radiance file; `rows` follow.
std::string hdr(const std::string& variables, const std::string& size, const std::string& rows) {
    return "#?RADIANCE\n" + variables + "FORMAT=32-bit_rle_rgbe\n\n" + size + "\n" + rows;
}

TEST(Formats, HdrPixelByPixel) {
    // Exponent 136 is a unit of 1.
    const std::string rows("\x01\x02\x03\x88\x80\x40\x00\x81", 8);
    EXPECT_THAT(valuesOf<Floats>(hdr("", "-Y 1 +X 2", rows)),
                ElementsAre(1, 2, 3, 1, 1, 0.5f, 0, 1));
    EXPECT_THAT(valuesOf<Floats>(hdr("EXPOSURE=2\n", "-Y 2 +X 1", rows)),
                ElementsAre(0.5f, 1, 1.5f, 1, 0.5f, 0.25f, 0, 1));
}

TEST(Formats, HdrRepeatsPixels) {
    const std::string rows("\x04\x02\x03\x88\x01\x01\x01\x02", 8);
    EXPECT_THAT(valuesOf<Floats>(hdr("", "-Y 1 +X 3", rows)),
                ElementsAre(4, 2, 3, 1, 4, 2, 3, 1, 4, 2, 3, 1));
}

TEST(Formats, HdrPackedRows) {
    // Eight pixels: red is a run, green is literal, blue a run of 3 and one of 5, then exponents.
    std::string rows("\x02\x02\x00\x08", 4);
    rows += std::string("\x88\x05", 2);
    rows += std::string("\x08\x00\x01\x02\x03\x04\x05\x06\x07", 9);
    rows += std::string("\x83\x01\x85\x02", 4);
    rows += std::string("\x88\x88", 2);
    const Floats values = valuesOf<Floats>(hdr("", "-Y 1 +X 8", rows));
    ASSERT_EQ(values.size(), 32u);
    for (int x = 0; x < 8; ++x) {
        EXPECT_EQ(values[4 * x], 5);
        EXPECT_EQ(values[4 * x + 1], x);
        EXPECT_EQ(values[4 * x + 2], x < 3 ? 1 : 2);
    }
}

/// A file that is there as long as the object.
struct File {
    std::filesystem::path path;
    explicit File(const std::string& bytes)
        : path(std::filesystem::path(testing::TempDir()) /
               ("stromboli_picture_" + std::to_string(getpid()))) {
        std::ofstream(path, std::ios::binary) << bytes;
    }
    ~File() { std::filesystem::remove(path); }
};

TEST(FloatImages, AreLinear) {
    const FloatImage eight = readFloatImage(File(test::png8(1, 1, 3, {0, 255, 188})).path);
    // IEC 61966-2-1 of 188 / 255.
    EXPECT_THAT(eight.texels.at(0).z, FloatEq(0.50288653f));
    EXPECT_EQ(eight.texels.at(0).x, 0);
    EXPECT_EQ(eight.texels.at(0).y, 1);
    const FloatImage deep =
        readFloatImage(File(test::exr(2, 1, "RGB", {1, 2, 3, 4, 5, 6}, false)).path);
    ASSERT_EQ(deep.width, 2u);
    EXPECT_EQ(deep.texels.at(1), glm::vec3(4, 5, 6));
}

TEST(FloatImages, WhatIsNoLightCountsAsNone) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const File file(test::exr(2, 1, "RGB", {1, 2, inf, 4, -5, 6}, false));
    const FloatImage image = readFloatImage(file.path);
    EXPECT_EQ(image.texels.at(0), glm::vec3(1, 2, 0));
    EXPECT_EQ(image.texels.at(1), glm::vec3(4, 0, 6));
    ASSERT_EQ(image.faults.size(), 1u);
    EXPECT_EQ(image.faults[0].kind, build::Shortfall::EnvironmentTexel);
    EXPECT_EQ(image.faults[0].problem, "2 texels are no light, the first at (0, 0), (1, 2, inf)");
}

TEST(ExrChannelNames, ALayerOfColoursIsShown) {
    const auto blender =
        exrChannels({"ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G",
                     "ViewLayer.Combined.R", "ViewLayer.Depth.Z"});
    ASSERT_TRUE(blender);
    EXPECT_EQ(blender->color[0], "ViewLayer.Combined.R");
    EXPECT_EQ(blender->alpha, "ViewLayer.Combined.A");
    const auto both = exrChannels({"B", "G", "R", "other.B", "other.G", "other.R"});
    ASSERT_TRUE(both);
    EXPECT_EQ(both->color[2], "B");
    const auto chroma = exrChannels({"BY", "RY", "Y"});
    ASSERT_TRUE(chroma);
    EXPECT_TRUE(chroma->isLuminance);
    EXPECT_FALSE(exrChannels({"Z", "U", "V"}));
}

TEST(FloatImages, BecomeMeansOfBlocksWhereTheyAreTooLarge) {
    const File file(test::exr(3, 2, "Y", {1, 2, 5, 3, 6, 7}, false));
    const FloatImage image = readFloatImage(file.path, 2);
    ASSERT_EQ(image.width, 2u);
    ASSERT_EQ(image.height, 1u);
    EXPECT_EQ(image.texels.at(0), glm::vec3(3)); // (1 + 2 + 3 + 6) / 4
    EXPECT_EQ(image.texels.at(1), glm::vec3(6)); // (5 + 7) / 2, of the rest of the row
    ASSERT_EQ(image.faults.size(), 1u);
    EXPECT_EQ(image.faults[0].kind, build::Shortfall::EnvironmentSize);
}

/// Two pixels a row of two rows, each as four bytes.
std::string hdrOf(const std::string& header, const std::string& size) {
    return "#?RADIANCE\n" + header + "\n" + size + "\n" + "\x80\x40\x20\x81" + "\x40\x40\x40\x81" +
           "\x20\x20\x20\x81" + "\x10\x10\x10\x81";
}

TEST(FloatImages, OfRadianceHaveAnyOrder) {
    // The first number of the four pixels, by the order in which they are in the file: 1, .5, .25
    // and .125; the picture's own order is from the left, then down.
    const std::pair<const char*, std::array<float, 4>> orders[] = {
        {"-Y 2 +X 2", {1, 0.5f, 0.25f, 0.125f}}, {"-Y 2 -X 2", {0.5f, 1, 0.125f, 0.25f}},
        {"+Y 2 +X 2", {0.25f, 0.125f, 1, 0.5f}}, {"+Y 2 -X 2", {0.125f, 0.25f, 0.5f, 1}},
        {"+X 2 -Y 2", {1, 0.25f, 0.5f, 0.125f}}, {"-X 2 -Y 2", {0.25f, 1, 0.125f, 0.5f}},
        {"+X 2 +Y 2", {0.5f, 0.125f, 1, 0.25f}}, {"-X 2 +Y 2", {0.125f, 0.5f, 0.25f, 1}}};
    for (const auto& [size, expected] : orders) {
        const FloatImage image = readFloatImage(File(hdrOf("", size)).path);
        for (size_t i = 0; i < 4; ++i)
            EXPECT_NEAR(image.texels.at(i).x, expected[i], 0.01f) << size << " " << i;
    }
}

/// Rows that are missing have no light.
TEST(FloatImages, OfRadianceThatEndTooEarlyAreShownAsFarAsTheyGo) {
    const std::string whole = hdrOf("", "-Y 2 +X 2");
    const FloatImage image = readFloatImage(File(whole.substr(0, whole.size() - 1)).path);
    EXPECT_EQ(image.texels.at(0).x, 1);
    EXPECT_EQ(image.texels.at(2), glm::vec3(0));
    EXPECT_EQ(image.texels.at(3), glm::vec3(0));
    ASSERT_EQ(image.faults.size(), 1u);
    EXPECT_EQ(image.faults[0].kind, build::Shortfall::PicturePart);
    EXPECT_EQ(image.faults[0].problem, "the file is truncated");
    EXPECT_THROW(readFloatImage(File(whole.substr(0, whole.size() - 9)).path), SceneError);
}

/// So it is in OpenEXR files for environments; what is compared or shown by itself has to be whole.
TEST(FloatImages, OfOpenExrThatEndTooEarlyAreShownAsFarAsTheyGo) {
    Floats noise(64 * 64 * 3);
    uint32_t random = 1;
    for (float& value : noise)
        value = float((random = random * 1664525u + 1013904223u) >> 8);
    const std::string whole = test::exr(64, 64, "RGB", noise, false);
    const File file(whole.substr(0, whole.size() / 2));
    const FloatImage image = readFloatImage(file.path);
    for (size_t i = 0; i < 64 * 16; ++i)
        EXPECT_EQ(image.texels.at(i).x, noise[3 * i]) << i;
    EXPECT_EQ(image.texels.at(64 * 64 - 1), glm::vec3(0));
    ASSERT_EQ(image.faults.size(), 1u);
    EXPECT_EQ(image.faults[0].kind, build::Shortfall::PicturePart);
    EXPECT_THROW(readRadiance(file.path), SceneError);
}

TEST(FloatImages, OfRadianceAreDividedByExposureAndColourCorrection) {
    const FloatImage plain = readFloatImage(File(hdrOf("", "-Y 2 +X 2")).path);
    const FloatImage corrected = readFloatImage(
        File(hdrOf("EXPOSURE=2\nEXPOSURE= 2\nCOLORCORR=2 1 0.5\n", "-Y 2 +X 2")).path);
    for (size_t i = 0; i < 4; ++i) {
        const glm::vec3 expected = plain.texels[i] / glm::vec3(8, 4, 2);
        EXPECT_EQ(corrected.texels.at(i), expected) << i;
    }
}

} // namespace
} // namespace stromboli::images
