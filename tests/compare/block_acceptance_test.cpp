// Means and blocks against a reference with a variance, on pictures whose z are known.
#include "host/compare/comparison.hpp"

#include "host/core/error.hpp"
#include "tests/compare/pictures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace stromboli::compare {
namespace {

constexpr uint64_t kPixels = kSide * kSide;
constexpr double kVariance = 0.04, kReference = 32000;
constexpr uint64_t kSamples = 868;

const glm::dvec3 kLinearOfEqualXyz = glm::inverse(kXyzFromLinear) * glm::dvec3(1.0);

Picture variances() {
    return constantPicture(kSide, kSide, kVariance * kLinearOfEqualXyz);
}
BlockAcceptance judge(const Picture& picture, double familyError = 0.01) {
    return judgeBlocks(greyReference(), variances(), picture, kSamples, kReference, familyError);
}
/// Deviation of a pixel's difference.
const double kDeviation = std::sqrt(kVariance * (1.0 / double(kSamples) + 1 / kReference));

TEST(BlockAcceptance, ZIsInStandardDeviationsOfSums) {
    Picture picture = greyReference();
    const double shift = 0.5 * kDeviation; // of each pixel of one block
    for (uint32_t y = 8; y < 16; ++y)
        for (uint32_t x = 40; x < 48; ++x)
            picture.rgb[y * kSide + x] += shift * kLinearOfEqualXyz;
    const BlockAcceptance a = judge(picture);
    EXPECT_NEAR(a.largest, 0.5 * 8, 1e-6);
    EXPECT_EQ(a.x, 40u);
    EXPECT_EQ(a.y, 8u);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(a.means[c], 0.5 * 64 / std::sqrt(double(kPixels)), 1e-6);
    EXPECT_EQ(a.tests, 3u * (36 + 1));
    EXPECT_NEAR(a.limit, 3.92, 0.01); // of 111 tests at 1 %
    EXPECT_FALSE(a.accepted());
    EXPECT_FALSE(a.hasOwnNoise);
}

/// What the other rule does not see: 0.5 % of the whole picture, an eighth of a pixel's noise.
TEST(BlockAcceptance, SeesASmallErrorOfTheWholePicture) {
    Picture picture = greyReference();
    for (glm::dvec3& p : picture.rgb)
        p *= 1.005;
    EXPECT_TRUE(judgeByVariance(greyReference(), variances(), picture, kSamples).accepted());
    const BlockAcceptance a = judge(picture);
    EXPECT_FALSE(a.accepted());
    EXPECT_NEAR(a.errors.y, 0.005, 1e-12);
    const double y = (kXyzFromLinear * glm::dvec3(0.5)).y;
    EXPECT_NEAR(a.means.y, 0.005 * y / kDeviation * kSide, 1e-6);
    EXPECT_NEAR(a.noise.y, kDeviation / (kSide * y), 1e-9);
}

/// As many right pictures fail as the error rate says: of 400 at 5 % 20, with a standard
/// deviation of 4.4.
TEST(BlockAcceptance, RightPicturesFailAsOftenAsItSays) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    int failed = 0;
    for (int trial = 0; trial < 400; ++trial) {
        Picture picture = greyReference();
        for (glm::dvec3& p : picture.rgb)
            p += glm::inverse(kXyzFromLinear) *
                 (kDeviation * glm::dvec3(normal(random), normal(random), normal(random)));
        failed += !judge(picture, 0.05).accepted();
    }
    EXPECT_NEAR(failed, 20, 4 * 4.4);
}

/// A picture's own variances count where it has them, as the largest that X, Y and Z may have.
TEST(BlockAcceptance, ThePicturesOwnNoiseCounts) {
    Film film(kSide, kSide);
    for (PixelStatistics& p : film.pixels) {
        p.count = 100;
        p.mean = glm::dvec3(0.5);
        p.m2 = glm::dvec3(0.09 * 99); // a variance of 0.09 of one sample
    }
    const BlockAcceptance a = judge(pictureOf(film));
    EXPECT_TRUE(a.hasOwnNoise);
    const glm::dvec3 one = kXyzFromLinear * glm::dvec3(1);
    const double own = 0.09 / 100 * one.y * one.y;
    EXPECT_NEAR(a.noise.y * 0.5 * one.y * kSide, std::sqrt(own + kVariance / kReference), 1e-9);
}

TEST(BlockAcceptance, WhatIsNotFiniteFails) {
    Picture picture = greyReference();
    picture.rgb[kSide * 20 + 30].z = std::numeric_limits<double>::quiet_NaN();
    const BlockAcceptance a = judge(picture);
    EXPECT_FALSE(a.accepted());
    EXPECT_EQ(a.x, 24u);
    EXPECT_EQ(a.y, 16u);
}

TEST(BlockAcceptance, DecidesOnlyIfAskedFor) {
    Picture picture = greyReference();
    for (glm::dvec3& p : picture.rgb)
        p *= 1.005;
    Comparison comparison = comparePictures(greyReference(), picture, {});
    comparison.blockAcceptance = judge(picture);
    EXPECT_TRUE(violations(comparison, {}).empty());
    EXPECT_THAT(violations(comparison, {.blocks = true}),
                testing::ElementsAre(testing::HasSubstr("the means of the picture or of blocks")));
    EXPECT_THAT(toText(comparison), testing::HasSubstr("by means and blocks"));
    comparison.blockAcceptance.reset();
    EXPECT_THROW(violations(comparison, {.blocks = true}), UsageError);
}

TEST(BlockAcceptance, SizesMustBeEqual) {
    const Picture small = constantPicture(2, 2, glm::dvec3(1));
    EXPECT_THROW(judge(small), UsageError);
}

} // namespace
} // namespace stromboli::compare
