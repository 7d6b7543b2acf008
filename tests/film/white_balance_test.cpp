// Illuminants by their temperature, and colours under them.
#include "host/film/white_balance.hpp"

#include "host/core/color.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

/// Linear light (Rec. 709) of luminance 1 that has the colour of an illuminant.
glm::dvec3 lightOf(double kelvin) {
    return glm::inverse(xyzFromRgb(kRec709)) * xyzOf(illuminantOf(kelvin));
}

/// CIE 15:2004: D50, D55, D65 and D75 have the correlated colour temperatures 5003,
/// 5503, 6504 and 7504 K.
TEST(Illuminants, OfDaylightAreThoseOfTheCie) {
    struct Row {
        double kelvin, x, y;
    };
    for (const Row& d : {Row{5003, 0.34567, 0.35851}, Row{5503, 0.33243, 0.34744},
                         Row{6504, 0.31272, 0.32903}, Row{7504, 0.29903, 0.31488}}) {
        EXPECT_NEAR(illuminantOf(d.kelvin).x, d.x, 1.5e-4) << d.kelvin;
        EXPECT_NEAR(illuminantOf(d.kelvin).y, d.y, 1.5e-4) << d.kelvin;
    }
}

/// Illuminant A is a black body of 2856 K, (0.44758, 0.40745) by the same; the formula is of
/// u and v within 9e-5, which are 3.2e-4 of y there.
TEST(Illuminants, OfLampsAreBlackBodies) {
    EXPECT_NEAR(illuminantOf(2856).x, 0.44758, 3.3e-4);
    EXPECT_NEAR(illuminantOf(2856).y, 0.40745, 3.3e-4);
}

/// Without a step, also where lamps become daylight. At 1000 K blue hardly changes: it is less than
/// none of Rec. 709.
TEST(Illuminants, BecomeColderWithTemperature) {
    for (double kelvin = 1200; kelvin + 10 <= kMostKelvin; kelvin += 10) {
        const glm::dvec3 warm = lightOf(kelvin), cold = lightOf(kelvin + 10);
        EXPECT_LT(cold.x, warm.x) << kelvin;
        EXPECT_GT(cold.z, warm.z) << kelvin;
        EXPECT_LT(std::fabs(illuminantOf(kelvin).x - illuminantOf(kelvin + 10).x), 0.005) << kelvin;
    }
}

TEST(WhiteBalance, TheIlluminantBecomesWhite) {
    for (const double kelvin : {1000.0, 1850.0, 2856.0, 3999.0, 4000.0, 5003.0, 7500.0, 25000.0}) {
        const glm::dvec3 white = whiteBalance(kelvin) * lightOf(kelvin);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(white[c], 1, 1e-9) << kelvin;
    }
}

/// The formula for daylight is of four digits, and of D65 (0.31272, 0.32903).
TEST(WhiteBalance, OfD65ChangesNothing) {
    const glm::dmat3 balance = whiteBalance(6504);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            EXPECT_NEAR(balance[column][row], column == row, 1e-3);
}

/// Published matrix: Lindbloom's Bradford adaptation of XYZ from D50 to D65.
TEST(WhiteBalance, AdaptsAsBradfordsMatrixDoes) {
    const glm::dmat3 found = chromaticAdaptation({0.96422, 1, 0.82521}, {0.95047, 1, 1.08883});
    const glm::dmat3 published(0.9555766, -0.0282895, 0.0122982, -0.0230393, 1.0099416, -0.0204830,
                               0.0631636, 0.0210077, 1.3299098);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            EXPECT_NEAR(found[column][row], published[column][row], 1e-6);
}

/// IEC 61966-2-1 prints the matrix with four digits.
TEST(WhiteBalance, ColoursAreThoseOfSrgb) {
    const glm::dmat3 found = xyzFromRgb(kRec709);
    const glm::dmat3 published(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722,
                               0.9505);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            EXPECT_NEAR(found[column][row], published[column][row], 6e-5);
}

TEST(WhiteBalance, WarmLightIsCooledAndColdLightWarmed) {
    const glm::dvec3 grey(0.5), fromWarm = whiteBalance(3000) * grey,
                                fromCold = whiteBalance(10000) * grey;
    EXPECT_LT(fromWarm.x, fromWarm.z);
    EXPECT_GT(fromCold.x, fromCold.z);
}

/// Only temperatures whose colours lack no channel: below 1900 K light has less than no blue of
/// Rec. 709.
TEST(NearestTemperature, OfAnIlluminantIsItsOwn) {
    for (double kelvin = 2000; kelvin <= 25000; kelvin += 500) {
        EXPECT_EQ(nearestTemperature(lightOf(kelvin)), kelvin);
        EXPECT_EQ(nearestTemperature(1e-6 * lightOf(kelvin)), kelvin);
    }
}

TEST(NearestTemperature, OfColoursThatAreNoIlluminantIsInTheRange) {
    for (const glm::dvec3& color :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 1)}) {
        EXPECT_GE(nearestTemperature(color), kLeastKelvin);
        EXPECT_LE(nearestTemperature(color), kMostKelvin);
    }
}

} // namespace
} // namespace stromboli
