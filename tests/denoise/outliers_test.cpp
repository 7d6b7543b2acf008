// Pixels that rest on single samples.
#include "host/denoise/prepare.hpp"
#include "tests/denoise/pictures.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;
using denoise::NoisyPicture;
using denoise::Prepared;
using denoise::sumOf;

constexpr uint32_t kSide = 24;
constexpr size_t kMiddle = 12 * kSide + 12;

/// Grey, with a little noise; the albedo differs from column to column.
NoisyPicture greyPicture() {
    return noisyPicture(
        kSide, kSide,
        [](uint32_t x, uint32_t) {
            Truth t;
            t.albedo = glm::vec3(x % 2 == 0 ? 0.50f : 0.54f);
            t.radiance = t.albedo;
            t.sigma = 0.1f;
            return t;
        },
        5);
}

glm::dvec3 lightOf(const Prepared& picture) {
    glm::dvec3 sum(0.0);
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        sum += glm::dvec3(picture.pixels[i].mean) * glm::dvec3(picture.albedo[i]);
    return sum;
}

TEST(Outliers, ASampleThatMakesAPixelIsSpreadAndNoLightIsLost) {
    NoisyPicture noisy = greyPicture();
    noisy.mean[kMiddle] = {50, 40, 30};
    noisy.deviation[kMiddle] = -noisy.mean[kMiddle];
    Prepared picture = denoise::prepare(noisy);
    const glm::dvec3 before = lightOf(picture);
    const std::vector<gpu::DenoisePixel> pixels = picture.pixels;
    denoise::limitOutliers(picture);
    EXPECT_EQ(picture.limitedPixels, 1u);
    const glm::dvec3 after = lightOf(picture);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(after[c], before[c], 1e-5 * before[c]);
    // Four standard errors of the neighbours, and what the pixel gets back of its own light.
    EXPECT_LT(picture.pixels[kMiddle].mean.x, 6 * picture.scale);
    EXPECT_GT(picture.pixels[kMiddle + 1].mean.x,
              pixels[kMiddle + 1].mean.x + 0.5f * picture.scale);
    // The error of who takes light is at least that light.
    EXPECT_GE(std::abs(picture.pixels[kMiddle + 1].deviation.x),
              picture.pixels[kMiddle + 1].mean.x - pixels[kMiddle + 1].mean.x);
    // Most of the light that there is was that pixel's.
    EXPECT_NEAR(picture.movedLight, 39.5 / (0.52 * kSide * kSide + 39.5), 0.02);
}

/// A small lamp is as bright in both halves of the samples.
TEST(Outliers, ABrightPixelThatAllSamplesAgreeOnStays) {
    NoisyPicture noisy = greyPicture();
    noisy.mean[kMiddle] = glm::vec3(50);
    noisy.deviation[kMiddle] = glm::vec3(1);
    Prepared picture = denoise::prepare(noisy);
    denoise::limitOutliers(picture);
    EXPECT_EQ(picture.limitedPixels, 0u);
    EXPECT_EQ(picture.movedLight, 0);
}

/// No neighbour shows the surface of this one, as is so at edges: then all neighbours say how
/// bright it may be.
TEST(Outliers, AnEdgeThatASampleMakesIsLimitedByItsNeighbours) {
    NoisyPicture noisy = greyPicture();
    noisy.normal[kMiddle] = {0.8f, 0.6f, 0};
    noisy.albedo[kMiddle] = glm::vec3(0.9f);
    noisy.mean[kMiddle] = {50, 40, 30};
    noisy.deviation[kMiddle] = noisy.mean[kMiddle];
    Prepared picture = denoise::prepare(noisy);
    const glm::dvec3 before = lightOf(picture);
    denoise::limitOutliers(picture);
    EXPECT_EQ(picture.limitedPixels, 1u);
    EXPECT_NEAR(sumOf(lightOf(picture)), sumOf(before), 1e-5 * sumOf(before));
    // What it was is above 55, and it gets back some of that.
    EXPECT_LT(picture.pixels[kMiddle].mean.x, 10 * picture.scale);
}

/// Where all pixels rest on single samples none is unlike the others.
TEST(Outliers, RareLightIsNotLimited) {
    NoisyPicture noisy = greyPicture();
    for (size_t i = 0; i < noisy.mean.size(); ++i) {
        noisy.mean[i] = i % 5 == 0 ? glm::vec3(2) : glm::vec3(0);
        noisy.deviation[i] = noisy.mean[i];
    }
    Prepared picture = denoise::prepare(noisy);
    denoise::limitOutliers(picture);
    EXPECT_EQ(picture.limitedPixels, 0u);
}

/// No pixel with normal errors of 40 % has most of its light in one half and is that far off.
TEST(Outliers, NormalNoiseIsNotLimited) {
    for (uint32_t seed = 1; seed <= 10; ++seed) {
        Prepared picture = denoise::prepare(noisyPicture(
            kSide, kSide,
            [](uint32_t, uint32_t) {
                Truth t;
                t.sigma = 0.4f;
                return t;
            },
            seed));
        denoise::limitOutliers(picture);
        EXPECT_EQ(picture.limitedPixels, 0u) << seed;
    }
}

} // namespace
} // namespace stromboli
