// Truncated and damaged pictures, and ones that claim absurd sizes, give one line.

#include "host/core/error.hpp"
#include "scene/images/picture.hpp"
#include "tests/scene/images/encoders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace stromboli::images {
namespace {

using testing::HasSubstr;

std::string messageOf(const std::string& bytes) {
    try {
        decodePicture(bytes, "a.png");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "none";
}

std::vector<std::string> someFiles() {
    std::vector<uint8_t> noise(16 * 16 * 4);
    std::mt19937 random(1);
    for (uint8_t& value : noise)
        value = uint8_t(random());
    const std::vector<float> floats(noise.begin(), noise.end());
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 7\n";
    hdr += std::string(16 * 7 * 4, '\x40');
    return {test::png8(16, 16, 4, noise), test::jpeg(16, 16, 3, noise), test::webp(16, 16, noise),
            test::exr(16, 16, "RGBA", floats, false), hdr};
}

TEST(DamagedPictures, SayWhatTheyAreNot) {
    EXPECT_EQ(messageOf(""), "a.png: is empty, expected a picture");
    EXPECT_EQ(messageOf("II*"), "a.png: is no picture that is read: expected PNG, JPEG, WebP, GIF, "
                                "BMP, TIFF, DDS, Radiance HDR, OpenEXR, PFM or TGA");
    EXPECT_THAT(messageOf("8BPS" + std::string(30, '\0')),
                HasSubstr("is a picture in Photoshop's PSD, which is not read: expected PNG"));
    EXPECT_THAT(messageOf("\xABKTX 20\xBB"), HasSubstr("is a picture in KTX, which is not read"));
    EXPECT_THAT(messageOf(std::string("\0\0\0\x1C", 4) + "ftypavif"), HasSubstr("in AVIF"));
    EXPECT_THAT(messageOf("GIF89a"), HasSubstr("a.png: cannot be read as GIF"));
}

/// Found by tests/fuzz.
TEST(DamagedPictures, ExposureWithoutANumber) {
    EXPECT_THAT(messageOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=\n\n-Y 1 +X 1\n"),
                HasSubstr("its exposure is ''"));
    EXPECT_THAT(messageOf("#?RADIANCE\nEXPOSURE=   \n\n-Y 1 +X 1\n"), HasSubstr("exposure is ''"));
}

/// An OpenEXR file: its magic, version 2 without flags, and what follows.
std::string exrOf(const std::string& rest) {
    return std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) + rest;
}

std::string attribute(const std::string& name, const std::string& type, uint32_t size,
                      const std::string& value) {
    std::string text = name + '\0' + type + '\0';
    for (int i = 0; i < 4; ++i)
        text += char(size >> 8 * i & 255u);
    return text + value;
}

/// The library would allocate what an attribute claims to have. Found by tests/fuzz.
TEST(DamagedPictures, AttributesOfExrFilesFitTheFile) {
    const std::string end(1, '\0');
    EXPECT_THAT(messageOf(exrOf(attribute("a", "own", 0x49424242, "x"))), HasSubstr("truncated"));
    EXPECT_THAT(messageOf(exrOf(attribute("a", "box2i", 15, std::string(15, 'x')) + end)),
                HasSubstr("another length than its type"));
    EXPECT_THAT(messageOf(exrOf(attribute("channels", "chlist", 3, std::string("R\0x", 3)) + end)),
                HasSubstr("truncated"));
    EXPECT_THAT(messageOf(exrOf(attribute("channels", "chlist", 3, std::string("\0xx", 3)) + end)),
                HasSubstr("another length than it says"));
    EXPECT_THAT(messageOf(exrOf(attribute("a", "stringvector", 5, "\x01\x01\x01\x01x") + end)),
                HasSubstr("truncated"));
    EXPECT_THAT(messageOf(exrOf(
                    attribute("p", "preview", 8, std::string("\xff\xff\xff\x7f\x01\0\0\0", 8)))),
                HasSubstr("preview"));
}

TEST(DamagedPictures, TruncatedAnywhere) {
    for (const std::string& file : someFiles())
        for (const double part : {0.1, 0.5, 0.9}) {
            const std::string message =
                messageOf(file.substr(0, size_t(double(file.size()) * part)));
            // What there is of most pictures is shown; formats_test.cpp sees that it is said.
            const bool isShown = part > 0.2;
            EXPECT_THAT(message, HasSubstr(isShown ? "" : "a.png: ")) << part;
            EXPECT_THAT(message, testing::Not(HasSubstr("\n")));
        }
}

TEST(DamagedPictures, NeverCrash) {
    std::mt19937 random(2);
    for (const std::string& file : someFiles())
        for (int i = 0; i < 200; ++i) {
            std::string damaged = file;
            for (int j = 0; j < 4; ++j)
                damaged[random() % damaged.size()] = char(random());
            EXPECT_THAT(messageOf(damaged), testing::Not(HasSubstr("\n")));
        }
}

TEST(DamagedPictures, AbsurdSizes) {
    EXPECT_THAT(messageOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\nabcd"),
                HasSubstr("claims 16384 x 16384 pixels, which 4 bytes cannot hold"));
    EXPECT_THAT(messageOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4000000\nabcd"),
                HasSubstr("4000000 x 1 pixels, expected at least 1 and at most 65536"));
    std::string exr = test::exr(1, 1, "Y", {1}, false);
    const std::string key = "dataWindow";
    const size_t window = exr.find(key) + key.size() + 1 + 6 + 4; // name, type and size of it
    exr.replace(window + 8, 4, std::string("\xFF\xFF\xFF\x7F", 4));
    EXPECT_THAT(messageOf(exr), HasSubstr("the picture has 2147483648 x 1 pixels"));
}

TEST(DamagedPictures, PngThatItsBytesCannotHold) {
    std::string png = test::png16(16384, 1, 4, std::vector<uint16_t>(16384 * 4, 0));
    EXPECT_EQ(messageOf(png), "none");
    std::string small = test::png16(16384, 64, 4, std::vector<uint16_t>(16384 * 4 * 64, 0));
    EXPECT_THAT(messageOf(small.substr(0, 200)), HasSubstr("which 200 bytes cannot hold"));
}

} // namespace
} // namespace stromboli::images
