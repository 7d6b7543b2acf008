#include "host/compare/comparison.hpp"
#include "host/core/error.hpp"
#include "tests/compare/pictures.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace stromboli::compare {
namespace {

/// A film of normal samples about 1, shifted by `shift`.
Picture noisyPicture(unsigned seed, double shift, uint32_t samples = 64) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(1 + shift, 0.2);
    Film film(24, 16);
    for (PixelStatistics& p : film.pixels)
        for (uint32_t i = 0; i < samples; ++i)
            p.add(glm::dvec3(std::max(noise(random), 0.0)));
    return pictureOf(std::move(film));
}

TEST(Comparison, ZTestsWhereBothHaveVariances) {
    // Standard error of the mean difference: 0.2 sqrt(2 / (24 16 64)) = 0.0018.
    const Picture a = noisyPicture(1, 0), b = noisyPicture(2, 0), shifted = noisyPicture(3, 0.02);
    const Comparison same = comparePictures(a, b, {}), other = comparePictures(a, shifted, {});
    ASSERT_TRUE(same.zTest && other.zTest);
    EXPECT_TRUE(same.zTest->agree());
    EXPECT_FALSE(other.zTest->agree());
    EXPECT_GT(other.zTest->channels[0].z, 5); // the picture is the brighter one
    EXPECT_FALSE(same.unevenSamples);
    Picture plain = b;
    plain.film.reset();
    EXPECT_FALSE(comparePictures(a, plain, {}).zTest);
    EXPECT_THROW(violations(comparePictures(a, plain, {}), {.zTest = true}), UsageError);
    EXPECT_EQ(violations(same, {.zTest = true}).size(), 0u);
    EXPECT_EQ(violations(other, {.zTest = true}).size(), 1u);
    // From a sample each nothing is found, because nothing can be.
    const Comparison blind = comparePictures(noisyPicture(1, 0, 1), noisyPicture(2, 0, 1), {});
    EXPECT_FALSE(blind.zTest->anyDiffers());
    EXPECT_EQ(violations(blind, {.zTest = true}).size(), 1u);
}

/// What is said twice is the same: the bias, and the difference of the means in the z-tests.
TEST(Comparison, BiasIsTheDifferenceOfTheMeans) {
    Picture brighter = noisyPicture(2, 0);
    for (PixelStatistics& p : brighter.film->pixels)
        p.mean *= 1.5;
    for (glm::dvec3& p : brighter.rgb)
        p *= 1.5;
    const Comparison c = comparePictures(noisyPicture(1, 0), brighter, {});
    ASSERT_TRUE(c.zTest);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_GT(c.errors.relativeBias[i], 0.3);
        EXPECT_NEAR(c.zTest->channels[i].relativeDifference, c.errors.relativeBias[i], 1e-6);
    }
}

TEST(Comparison, SaysThatSampleCountsVary) {
    Picture a = noisyPicture(1, 0), b = noisyPicture(2, 0);
    b.film->pixels[7].add(glm::dvec3(1));
    EXPECT_TRUE(comparePictures(a, b, {}).unevenSamples);
}

TEST(Comparison, EveryLimitIsKeptAtItsValueAndBrokenBeyond) {
    const Picture a = randomPicture(20, 12, 1), b = randomPicture(20, 12, 2);
    const Comparison c = comparePictures(a, b, {});
    const double bias =
        100 * std::max({std::abs(c.errors.relativeBias[0]), std::abs(c.errors.relativeBias[1]),
                        std::abs(c.errors.relativeBias[2])});
    const Thresholds kept = {.mse = c.errors.mse,
                             .relMse = c.errors.relMse,
                             .flip = c.flip,
                             .biasPercent = bias,
                             .psnr = c.psnr,
                             .ssim = c.ssim};
    EXPECT_TRUE(violations(c, kept).empty());
    const double less = 1 - 1e-9, more = 1 + 1e-9;
    EXPECT_EQ(violations(c, {.mse = less * c.errors.mse}).size(), 1u);
    EXPECT_EQ(violations(c, {.relMse = less * c.errors.relMse}).size(), 1u);
    EXPECT_EQ(violations(c, {.flip = less * c.flip}).size(), 1u);
    EXPECT_EQ(violations(c, {.biasPercent = less * bias}).size(), 1u);
    EXPECT_EQ(violations(c, {.psnr = more * c.psnr}).size(), 1u);
    EXPECT_EQ(violations(c, {.ssim = c.ssim + 1e-9}).size(), 1u);
}

TEST(Comparison, APixelThatIsNotFiniteBreaksEveryLimitButNoFigure) {
    const Picture a = randomPicture(8, 8, 1);
    Picture b = a;
    b.rgb[9].x = std::numeric_limits<double>::quiet_NaN();
    const Comparison c = comparePictures(a, b, {});
    EXPECT_EQ(c.notFinitePicture, 1u);
    EXPECT_EQ(c.errors.mse, 0);
    EXPECT_EQ(c.flip, 0);
    EXPECT_EQ(violations(c, {.relMse = 1}).size(), 1u);
    EXPECT_EQ(violations(c, {}).size(), 0u);
    Picture noisy = noisyPicture(1, 0);
    noisy.rgb[9].x = std::numeric_limits<double>::infinity();
    EXPECT_EQ(comparePictures(noisy, noisyPicture(2, 0), {}).zTest->pixels, 24u * 16 - 1);
}

TEST(Comparison, AsManyPixelsThatAreNotFiniteAsTheReferenceHasAreNoExcuse) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Picture a = randomPicture(8, 8, 1), b = a;
    a.rgb[3].y = nan;
    b.rgb[9].x = nan;
    EXPECT_EQ(violations(comparePictures(a, b, {}), {.relMse = 1}).size(), 1u);
    b = a; // in the same place: left out
    EXPECT_EQ(violations(comparePictures(a, b, {}), {.relMse = 1}).size(), 0u);
    for (glm::dvec3& c : a.rgb)
        c = glm::dvec3(nan);
    EXPECT_EQ(violations(comparePictures(a, a, {}), {.relMse = 1}).size(), 1u); // nothing is left
}

TEST(Comparison, NoLimitIsKeptByANaN) {
    const Picture a = randomPicture(8, 8, 1);
    Comparison c = comparePictures(a, a, {});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    c.errors.mse = c.errors.relMse = c.flip = c.psnr = c.ssim = nan;
    c.errors.relativeBias = {nan, nan, nan};
    const Thresholds all = {
        .mse = 1, .relMse = 1, .flip = 1, .biasPercent = 1, .psnr = 1, .ssim = 0};
    EXPECT_EQ(violations(c, all).size(), 8u); // three of them biases
}

TEST(Comparison, FlipIsOfHighDynamicRangeForLinearPicturesOnly) {
    const Picture a = randomPicture(8, 8, 1, 3), b = randomPicture(8, 8, 2, 3);
    Picture png = b;
    png.lowDynamicRange = true;
    EXPECT_TRUE(comparePictures(a, b, {}).highDynamicRange);
    const Comparison low = comparePictures(a, png, {});
    EXPECT_FALSE(low.highDynamicRange);
    EXPECT_DOUBLE_EQ(low.flip, meanOf(flipMap(a, b)));
}

TEST(Comparison, JsonHasNoInfinity) {
    const Picture a = randomPicture(4, 4, 1);
    const auto json = nlohmann::json::parse(toJson(comparePictures(a, a, {})).dump());
    EXPECT_TRUE(json["psnr"].is_null());
    EXPECT_EQ(json["ssim"], 1.0);
    EXPECT_EQ(json["relMse"], 0.0);
}

TEST(Comparison, OtherSizesAreAUserError) {
    EXPECT_THROW(comparePictures(Picture(2, 3), Picture(3, 2), {}), UsageError);
}

} // namespace
} // namespace stromboli::compare
