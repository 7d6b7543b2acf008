// Pictures of files and films, as the denoiser sees them; what is no number.
#include "host/core/error.hpp"
#include "host/denoise/denoiser.hpp"
#include "tests/denoise/pictures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli {
namespace {

using namespace test;
using denoise::NoisyPicture;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr uint32_t kImageWidth = 40, kImageHeight = 30;

void fill(FloatImage& image, const std::vector<std::string>& names, float value) {
    for (const std::string& name : names)
        image.channel(name).assign(size_t(image.width) * image.height, value);
}

const std::vector<std::string> kColor = {"R", "G", "B"};
const std::vector<std::string> kVariance = {"variance.R", "variance.G", "variance.B"};

/// mean + deviation and mean - deviation are independent if the deviation has the variance of the
/// mean and does not know its error.
TEST(NoisyPicture, AVarianceBecomesADeviationOfIt) {
    FloatImage image(200, 200);
    fill(image, kColor, 1);
    fill(image, kVariance, 0.04f);
    const NoisyPicture picture = denoise::noisyPictureOf(image, "a.exr");
    double sum = 0, squares = 0, neighbours = 0, channels = 0;
    const size_t count = picture.deviation.size();
    for (size_t i = 0; i < count; ++i) {
        EXPECT_EQ(picture.mean[i], glm::vec3(1));
        const glm::dvec3 d = picture.deviation[i];
        sum += d.x, squares += d.x * d.x, channels += d.x * d.y;
        neighbours += d.x * picture.deviation[(i + 1) % count].x;
    }
    // Four standard errors of 40,000 normal numbers.
    EXPECT_NEAR(sum / double(count), 0, 4 * 0.2 / 200);
    EXPECT_NEAR(squares / double(count), 0.04, 4 * 0.04 * std::sqrt(2.0) / 200);
    EXPECT_NEAR(neighbours / double(count), 0, 4 * 0.04 / 200);
    EXPECT_NEAR(channels / double(count), 0, 4 * 0.04 / 200);
}

TEST(NoisyPicture, HalvesAreTakenAsTheyAre) {
    FloatImage image(2, 1);
    fill(image, {"halfA.R", "halfA.G", "halfA.B"}, 3);
    fill(image, {"halfB.R", "halfB.G", "halfB.B"}, 1);
    const NoisyPicture picture = denoise::noisyPictureOf(image, "a.exr");
    EXPECT_EQ(picture.mean[1], glm::vec3(2));
    EXPECT_EQ(picture.deviation[1], glm::vec3(1));
}

TEST(NoisyPicture, LayersHaveTheNamesOfOtherPrograms) {
    FloatImage image(2, 1);
    fill(image, {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"}, 1);
    fill(image, kVariance, 0.1f);
    fill(image,
         {"ViewLayer.Denoising Albedo.R", "ViewLayer.Denoising Albedo.G",
          "ViewLayer.Denoising Albedo.B"},
         0.3f);
    fill(image,
         {"ViewLayer.Denoising Normal.X", "ViewLayer.Denoising Normal.Y",
          "ViewLayer.Denoising Normal.Z"},
         0.6f);
    fill(image, {"ViewLayer.Depth.Z"}, 2);
    const NoisyPicture picture = denoise::noisyPictureOf(image, "a.exr");
    EXPECT_EQ(picture.albedo.at(1), glm::vec3(0.3f));
    EXPECT_EQ(picture.normal.at(1), glm::vec3(0.6f));
    EXPECT_EQ(picture.depth.at(1), 2.0f);
}

TEST(NoisyPicture, SaysWhatIsMissing) {
    FloatImage image(2, 1);
    fill(image, {"albedo.R"}, 1);
    EXPECT_THAT([&] { denoise::noisyPictureOf(image, "a.exr"); },
                ThrowsMessage<UsageError>(HasSubstr("a.exr: it has no channels R, G, B, but "
                                                    "albedo.R")));
    fill(image, kColor, 1);
    EXPECT_THAT([&] { denoise::noisyPictureOf(image, "a.exr"); },
                ThrowsMessage<UsageError>(HasSubstr("how noisy it is cannot be told")));
}

TEST(NoisyPicture, AFilmIsTakenWithItsErrors) {
    Film film(3, 1);
    std::vector<glm::dvec3> squaredErrors(3, glm::dvec3(0.25));
    for (int i = 0; i < 3; ++i)
        for (int sample = 0; sample < 2 * i; ++sample) // none, two, four
            film.pixels[size_t(i)].add(glm::dvec3(i));
    const NoisyPicture picture = denoise::noisyPictureOf(film, squaredErrors, FloatImage{});
    EXPECT_EQ(picture.unknownPixels, 1u);
    EXPECT_FALSE(std::isfinite(picture.mean[0].x));
    EXPECT_EQ(picture.mean[2], glm::vec3(2));
    EXPECT_EQ(std::abs(picture.deviation[2].y), 0.5f);
    EXPECT_TRUE(picture.albedo.empty());
}

/// A pixel that is no number shows what is around it, and nobody looks at it.
TEST(NoisyPicture, WhatIsNoNumberIsFilledIn) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    FloatImage image(kImageWidth, kImageHeight);
    fill(image, kColor, 2);
    fill(image, kVariance, 0.01f);
    fill(image, {"albedo.R", "albedo.G", "albedo.B"}, 0.5f);
    fill(image, {"normal.X", "normal.Y", "normal.Z"}, 0.5f);
    fill(image, {"depth.Z"}, 3);
    const size_t at = 10 * kImageWidth + 10;
    image.channel("R")[at] = kNan;
    image.channel("G")[at + 7] = kInf;
    image.channel("variance.B")[at + 90] = kNan;
    image.channel("B")[at + 91] = -kInf;
    image.channel("albedo.R")[at + 200] = kNan;
    image.channel("normal.Y")[at + 201] = kInf;
    image.channel("depth.Z")[at + 202] = kNan;
    image.channel("depth.Z")[at + 203] = kInf;
    const NoisyPicture noisy = denoise::noisyPictureOf(image, "a.exr");
    EXPECT_EQ(noisy.unknownPixels, 4u);
    const denoise::DenoisedPicture d = denoise::denoisePicture(noisy, Denoiser::On, nullptr);
    EXPECT_EQ(d.summary.unknownPixels, 4u);
    for (size_t i = 0; i < d.mean.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(d.mean[i][c], 2, 1e-5) << i;
            EXPECT_TRUE(std::isfinite(d.error[i][c])) << i;
        }
}

TEST(NoisyPicture, ThatIsNoNumberAnywhereIsBlack) {
    FloatImage image(kImageWidth, kImageHeight);
    fill(image, kColor, std::numeric_limits<float>::quiet_NaN());
    fill(image, kVariance, 0.01f);
    const denoise::DenoisedPicture d =
        denoise::denoisePicture(denoise::noisyPictureOf(image, "a.exr"), Denoiser::On, nullptr);
    for (const glm::vec3& p : d.mean)
        EXPECT_EQ(p, glm::vec3(0));
}

} // namespace
} // namespace stromboli
