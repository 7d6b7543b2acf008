#include "host/compare/flip.hpp"
#include "tests/compare/pictures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli::compare {
namespace {

TEST(FalseColor, CubehelixGrowsEvenlyInBrightness) {
    EXPECT_EQ(cubehelix(0), glm::dvec3(0));
    EXPECT_EQ(cubehelix(1), glm::dvec3(1));
    EXPECT_EQ(cubehelix(-3), glm::dvec3(0));
    EXPECT_EQ(cubehelix(7), glm::dvec3(1));
    EXPECT_EQ(cubehelix(std::numeric_limits<double>::quiet_NaN()), glm::dvec3(0));
    for (double v = 0; v <= 1; v += 0.05) {
        const glm::dvec3 c = cubehelix(v); // brightness by NTSC weights, as in Green's paper
        EXPECT_NEAR(0.30 * c.x + 0.59 * c.y + 0.11 * c.z, v, 2e-3);
    }
}

TEST(FalseColor, SignedDifferenceByHand) {
    Picture reference = constantPicture(4, 1, glm::dvec3(1)), picture = reference;
    picture.rgb = {glm::dvec3(1), glm::dvec3(1.55), glm::dvec3(0.45), glm::dvec3(9)};
    const ByteImage image = signedDifference(reference, picture); // divided by 1 + 0.1
    const uint8_t expected[4][3] = {{255, 255, 255}, {255, 128, 128}, {128, 128, 255}, {255, 0, 0}};
    for (uint32_t x = 0; x < 4; ++x)
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(image.pixel(x, 0)[c], expected[x][c]) << x;
}

TEST(FalseColor, ScalesToTheTop) {
    const double values[] = {0, 2};
    const ByteImage image = falseColor(values, 2, 1, 2);
    EXPECT_EQ(image.pixel(0, 0)[1], 0);
    EXPECT_EQ(image.pixel(1, 0)[1], 255);
}

} // namespace
} // namespace stromboli::compare
