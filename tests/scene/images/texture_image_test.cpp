#include "host/core/error.hpp"
#include "scene/images/texture_image.hpp"
#include "scene/model/srgb.hpp"

#include <glm/gtc/packing.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::images {
namespace {

using testing::ElementsAre;

TEST(TextureImages, KeepEightBits) {
    const Picture picture{2, 1, std::vector<uint8_t>{1, 2, 3, 4, 5, 6, 7, 8}};
    const TextureImage image = textureImage(picture, "a", true);
    EXPECT_EQ(image.format, TexelFormat::Rgba8);
    EXPECT_THAT(image.words, ElementsAre(0x04030201u, 0x08070605u));
}

TEST(TextureImages, DecodeSixteenBits) {
    const Picture picture{1, 1, std::vector<uint16_t>{0, 32768, 65535, 32768}};
    const double half = 32768.0 / 65535;
    const TextureImage srgb = textureImage(picture, "a", true);
    EXPECT_EQ(srgb.format, TexelFormat::RgbaHalf);
    const glm::vec2 low = glm::unpackHalf2x16(srgb.words.at(0));
    const glm::vec2 high = glm::unpackHalf2x16(srgb.words.at(1));
    EXPECT_NEAR(low.y, srgbToLinear(half), 0x1p-12); // half of a half float's unit at 1/4
    EXPECT_EQ(high.x, 1);
    EXPECT_NEAR(high.y, half, 0x1p-11); // alpha is not decoded
    const TextureImage linear = textureImage(picture, "a", false);
    EXPECT_NEAR(glm::unpackHalf2x16(linear.words.at(0)).y, half, 0x1p-11);
}

TEST(TextureImages, ClampFloatsAndRefuseNaN) {
    const Picture large{1, 1, std::vector<float>{1e30f, -1e30f, 0.5f, 1}};
    const TextureImage image = textureImage(large, "a", false);
    EXPECT_EQ(glm::unpackHalf2x16(image.words.at(0)), glm::vec2(65504, -65504));
    const Picture bad{1, 1, std::vector<float>{1, NAN, 0, 1}};
    EXPECT_THROW(textureImage(bad, "a", false), SceneError);
}

TextureImage grey(uint32_t width, uint32_t height, const std::vector<uint8_t>& values) {
    TextureImage image{"a", width, height, TexelFormat::Rgba8, {}};
    for (const uint8_t v : values)
        image.words.push_back(uint32_t(v) * 0x01010101u);
    return image;
}

TEST(Shrinking, TakesMeans) {
    TextureImage image = grey(4, 2, {0, 40, 8, 8, 80, 120, 8, 8});
    shrinkToFit(image, 2, false);
    EXPECT_EQ(image.width, 2u);
    EXPECT_EQ(image.height, 1u);
    EXPECT_THAT(image.words, ElementsAre(60 * 0x01010101u, 8 * 0x01010101u));
}

TEST(Shrinking, CoversOddSidesEvenly) {
    // Three texels become one; five become two, which share the middle one.
    TextureImage three = grey(3, 1, {30, 60, 90});
    shrinkToFit(three, 1, false);
    EXPECT_THAT(three.words, ElementsAre(60 * 0x01010101u));
    TextureImage five = grey(5, 1, {10, 10, 20, 30, 30});
    shrinkToFit(five, 4, false);
    EXPECT_THAT(five.words, ElementsAre(12 * 0x01010101u, 28 * 0x01010101u));
}

TEST(Shrinking, MixesLightNotCodes) {
    TextureImage image = grey(2, 1, {0, 255});
    shrinkToFit(image, 1, true);
    // Half of the light has the code 188; alpha is the mean of its numbers.
    EXPECT_EQ(image.words.at(0), 0x80BCBCBCu);
}

TEST(Shrinking, LeavesWhatFits) {
    TextureImage image = grey(2, 2, {1, 2, 3, 4});
    const std::vector<uint32_t> before = image.words;
    shrinkToFit(image, 2, true);
    EXPECT_EQ(image.words, before);
}

TEST(Shrinking, HalfFloats) {
    TextureImage image{"a", 2, 1, TexelFormat::RgbaHalf, {}};
    for (const float v : {1.0f, 3.0f}) {
        image.words.push_back(glm::packHalf2x16({v, 2 * v}));
        image.words.push_back(glm::packHalf2x16({0, 1}));
    }
    shrinkToFit(image, 1, false);
    EXPECT_EQ(glm::unpackHalf2x16(image.words.at(0)), glm::vec2(2, 4));
}

} // namespace
} // namespace stromboli::images
