// Errors of pictures small enough to add up by hand.
#include "host/compare/metrics.hpp"
#include "host/film/image_file.hpp"
#include "tests/compare/pictures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace stromboli::compare {
namespace {

TEST(LinearErrors, OfTwoPixelsByHand) {
    Picture reference(2, 1), picture(2, 1);
    reference.rgb = {{1, 2, 0}, {3, 0, 0}}; // mean 1: epsilon is 0.01
    picture.rgb = {{1, 4, 1}, {2, 0, 0}};
    const LinearErrors e = linearErrors(reference, picture);
    EXPECT_DOUBLE_EQ(e.epsilon, 0.01);
    EXPECT_DOUBLE_EQ(e.mse, (4 + 1 + 1) / 6.0);
    EXPECT_DOUBLE_EQ(e.relMse, (4 / 4.01 + 1 / 0.01 + 1 / 9.01) / 6);
    EXPECT_DOUBLE_EQ(e.bias[0], -0.5);
    EXPECT_DOUBLE_EQ(e.bias[1], 1);
    EXPECT_DOUBLE_EQ(e.bias[2], 0.5);
    EXPECT_DOUBLE_EQ(e.relativeBias[0], -0.25);
    EXPECT_DOUBLE_EQ(e.relativeBias[1], 1);
    EXPECT_TRUE(std::isinf(e.relativeBias[2])); // from black
}

TEST(LinearErrors, RelativeErrorDoesNotDependOnTheUnitOfRadiance) {
    const Picture a = randomPicture(9, 7, 1), b = randomPicture(9, 7, 2);
    const double expected = linearErrors(a, b).relMse;
    for (const double factor : {1e-12, 1e12})
        EXPECT_NEAR(linearErrors(scaled(a, factor), scaled(b, factor)).relMse, expected,
                    1e-12 * expected);
}

TEST(LinearErrors, EqualPicturesHaveNone) {
    for (const Picture& p : {randomPicture(5, 5, 3), constantPicture(5, 5, glm::dvec3(0))}) {
        const LinearErrors e = linearErrors(p, p);
        EXPECT_EQ(e.mse, 0);
        EXPECT_EQ(e.relMse, 0);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_EQ(e.relativeBias[c], 0);
    }
}

TEST(LinearErrors, TheMapsMeanIsTheRelativeError) {
    const Picture a = randomPicture(8, 3, 4), b = randomPicture(8, 3, 5);
    const std::vector<double> map = relativeErrorMap(a, b);
    EXPECT_NEAR(std::accumulate(map.begin(), map.end(), 0.0) / double(map.size()),
                linearErrors(a, b).relMse, 1e-12);
}

TEST(LinearErrors, OtherSizesAreRefused) {
    EXPECT_THROW(linearErrors(Picture(2, 3), Picture(3, 2)), std::invalid_argument);
    EXPECT_THROW(psnr(Picture(2, 3), Picture(3, 2)), std::invalid_argument);
}

TEST(Psnr, OfAConstantDifferenceOfSignals) {
    // Signals 0.5 and 0.6: 10 log10(1 / 0.1^2) = 20 dB.
    const Picture a = constantPicture(3, 2, glm::dvec3(linearFromSrgb(0.5)));
    const Picture b = constantPicture(3, 2, glm::dvec3(linearFromSrgb(0.6)));
    EXPECT_NEAR(psnr(a, b), 20, 1e-6);
    // The curve's published constants meet to some 1e-8 only.
    EXPECT_NEAR(psnr(scaled(a, 0.25), scaled(b, 0.25), 2), 20, 1e-6);
    EXPECT_TRUE(std::isinf(psnr(a, a)));
}

TEST(Psnr, WhatIsBrighterThanTheScreenIsEqual) {
    EXPECT_TRUE(std::isinf(
        psnr(constantPicture(2, 2, glm::dvec3(1)), constantPicture(2, 2, glm::dvec3(50)))));
}

} // namespace
} // namespace stromboli::compare
