// Mitsuba's rule of acceptance, on pictures whose z are known.

#include "host/compare/comparison.hpp"
#include "host/core/error.hpp"
#include "tests/compare/pictures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli::compare {
namespace {

/// Linear sRGB of XYZ (1, 1, 1): the sums of the rows of the inverse of the matrix.
const glm::dvec3 kEqualXyz(1.204805, 0.948293, 0.908916);

/// The variance `variance` of one sample in each of X, Y and Z.
Picture variances(double variance) {
    return constantPicture(kSide, kSide, variance * kEqualXyz);
}
/// The reference, with X, Y and Z of its first `count` pixels larger by `shift`.
Picture shifted(size_t count, double shift) {
    Picture picture = greyReference();
    for (size_t i = 0; i < count; ++i)
        picture.rgb[i] += shift * kEqualXyz;
    return picture;
}

/// 1 - 0.99^(1 / 2304) = 4.362e-6 is what a normal variable is beyond 4.594 with.
TEST(Acceptance, LimitIsThatOfOnePixelInAHundredPictures) {
    const Acceptance a = judgeByVariance(greyReference(), variances(0.04), greyReference(), 868);
    EXPECT_NEAR(a.limit, 4.59, 0.005);
    EXPECT_NEAR(std::erfc(a.limit / std::sqrt(2.0)), 1 - std::pow(0.99, 1.0 / (kSide * kSide)),
                1e-10);
    EXPECT_EQ(a.tests, 3u * kSide * kSide);
    EXPECT_EQ(a.passing, a.tests);
    EXPECT_EQ(a.largest, 0);
    EXPECT_TRUE(a.accepted());
}

/// If the variance is 0.04, 400 samples have a standard deviation of 0.2 / 20 = 0.01.
TEST(Acceptance, ZIsInStandardDeviationsOfTheMeanInXyz) {
    const Acceptance a = judgeByVariance(greyReference(), variances(0.04), shifted(1, 0.03), 400);
    EXPECT_NEAR(a.largest, 3, 1e-4);
    // At 1/4 of the samples half of it, and below a variance of 1e-4 as at 1e-4.
    EXPECT_NEAR(judgeByVariance(greyReference(), variances(0.04), shifted(1, 0.03), 100).largest,
                1.5, 1e-4);
    for (const double tiny : {1e-4, 1e-9, 0.0, -1.0})
        EXPECT_NEAR(
            judgeByVariance(greyReference(), variances(tiny), shifted(1, 0.003), 100).largest, 3,
            1e-4);
}

/// A red error has parts in X, Y and Z by the matrix of sRGB: 0.412453, 0.212671, 0.019334.
TEST(Acceptance, ColoursAreThoseOfSrgb) {
    Picture picture = greyReference();
    picture.rgb[5].x += 0.1;
    EXPECT_NEAR(judgeByVariance(greyReference(), variances(0.04), picture, 400).largest, 4.12453,
                1e-4);
}

TEST(Acceptance, BeyondTheLimitATestFails) {
    const double limit =
        judgeByVariance(greyReference(), variances(0.04), greyReference(), 400).limit;
    for (const double side : {0.999, 1.001}) {
        const Acceptance a =
            judgeByVariance(greyReference(), variances(0.04), shifted(1, side * limit * 0.01), 400);
        EXPECT_EQ(a.tests - a.passing, side < 1 ? 0u : 3u);
    }
}

/// 0.25 % of 6912 tests are 17.28: of three tests a pixel, those of five pixels may fail.
TEST(Acceptance, AShareOfTheTestsMayFail) {
    Comparison comparison = comparePictures(greyReference(), shifted(5, 1), {});
    comparison.acceptance = judgeByVariance(greyReference(), variances(0.04), shifted(5, 1), 400);
    EXPECT_EQ(comparison.acceptance->tests - comparison.acceptance->passing, 15u);
    EXPECT_TRUE(comparison.acceptance->accepted());
    EXPECT_TRUE(violations(comparison, {}).empty());
    EXPECT_THAT(toText(comparison), testing::HasSubstr(": ACCEPTED"));

    comparison.acceptance = judgeByVariance(greyReference(), variances(0.04), shifted(6, 1), 400);
    EXPECT_EQ(comparison.acceptance->tests - comparison.acceptance->passing, 18u);
    EXPECT_FALSE(comparison.acceptance->accepted());
    EXPECT_THAT(violations(comparison, {}),
                testing::ElementsAre(testing::HasSubstr("99.7396 % of the z-tests")));
    EXPECT_THAT(toText(comparison), testing::HasSubstr("NOT ACCEPTED"));
}

/// For very many samples the reference's own noise, that of 32,000, is no longer small.
TEST(Acceptance, ManySamplesMeetANoisyReference) {
    const double n = 32000;
    EXPECT_NEAR(
        judgeByVariance(greyReference(), variances(0.04), shifted(1, 0.01), uint64_t(n)).largest,
        0.01 / std::sqrt(0.04 * 2 / n), 1e-3);
}

TEST(Acceptance, WhatIsNotFiniteFails) {
    Picture picture = greyReference();
    picture.rgb[kSide + 2].y = std::numeric_limits<double>::quiet_NaN();
    const Acceptance a = judgeByVariance(greyReference(), variances(0.04), picture, 400);
    EXPECT_EQ(a.tests - a.passing, 3u);
    EXPECT_TRUE(std::isinf(a.largest));
    EXPECT_EQ(a.x, 2u);
    EXPECT_EQ(a.y, 1u);
}

TEST(Acceptance, SizesMustBeEqual) {
    const Picture small = constantPicture(2, 2, glm::dvec3(1));
    EXPECT_THROW(judgeByVariance(greyReference(), small, greyReference(), 1), UsageError);
    EXPECT_THROW(judgeByVariance(greyReference(), variances(1), small, 1), UsageError);
}

} // namespace
} // namespace stromboli::compare
