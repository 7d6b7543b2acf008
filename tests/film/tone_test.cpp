#include "host/film/image_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace stromboli {
namespace {

constexpr ToneCurve kSrgb{};
constexpr ToneCurve kPower{ToneCurve::Kind::Power};

/// IEC 61966-2-1, written down once more in extended precision.
long double standardSrgb(long double linear) {
    if (linear <= 0.0031308L) return 12.92L * linear;
    return 1.055L * powl(linear, 1 / 2.4L) - 0.055L;
}

TEST(SrgbCurve, IsTheStandardOneToeIncluded) {
    for (int i = 0; i <= 100'000; ++i) {
        const double linear = std::pow(i / 100'000.0, 3); // dense near the toe at 0.0031
        EXPECT_NEAR(srgbFromLinear(linear), double(standardSrgb(linear)), 4e-16) << linear;
    }
}

/// A byte is right if its signal is within half a step of the curve.
TEST(SrgbCurve, BytesAreTheNearest) {
    for (int i = 0; i <= 100'000; ++i) {
        const double linear = std::pow(i / 100'000.0, 3);
        const long double exact = 255 * standardSrgb(linear);
        EXPECT_LE(std::fabs(double(kSrgb.toByte(linear) - exact)), 0.5 + 1e-12) << linear;
    }
}

TEST(SrgbCurve, KnownValues) {
    EXPECT_EQ(kSrgb.toByte(0), 0);
    EXPECT_EQ(kSrgb.toByte(1), 255);
    EXPECT_EQ(kSrgb.toByte(0.18), 118);     // 117.7: middle grey
    EXPECT_EQ(kSrgb.toByte(0.5), 188);      // 187.5
    EXPECT_EQ(kSrgb.toByte(0.00015), 0);    // 0.494
    EXPECT_EQ(kSrgb.toByte(0.00016), 1);    // 0.527
    EXPECT_EQ(kSrgb.toByte(0.0031308), 10); // 10.31: where the toe ends
}

TEST(SrgbCurve, InverseTakesEveryByteBack) {
    for (int byte = 0; byte < 256; ++byte)
        EXPECT_EQ(kSrgb.toByte(linearFromSrgb(byte / 255.0)), byte);
}

TEST(Exposure, OneStopDoubles) {
    for (double stops : {-3.0, -0.5, 1.0, 2.5}) {
        const ToneCurve curve{ToneCurve::Kind::Srgb, stops};
        for (double radiance : {0.001, 0.01, 0.1, 0.3})
            EXPECT_EQ(curve.toByte(radiance), kSrgb.toByte(radiance * std::pow(2, stops)));
    }
}

TEST(PowerCurve, IsTheTruncatedPower) {
    for (int i = 0; i <= 100'000; ++i) {
        const double radiance = std::pow(i / 100'000.0, 3);
        const long double exact = 255 * std::min(1.0L, powl(sqrtl(2.0L) * radiance, 1 / 2.2L));
        const int byte = kPower.toByte(radiance);
        EXPECT_LE(byte, double(exact) + 1e-12) << radiance;
        EXPECT_GT(byte + 1, double(exact) - 1e-12) << radiance;
    }
}

TEST(PowerCurve, KnownValues) {
    EXPECT_EQ(kPower.toByte(0), 0);
    EXPECT_EQ(kPower.toByte(0.7072), 255); // saturates at sqrt(1/2)
    EXPECT_EQ(kPower.toByte(0.7071), 254);
    EXPECT_EQ(kPower.toByte(0.1), 104); // 104.81, not rounded
}

TEST(PowerCurve, InverseTakesEveryByteBack) {
    for (int byte = 0; byte < 256; ++byte)
        EXPECT_EQ(kPower.toByte(radianceFromPower(static_cast<uint8_t>(byte))), byte);
}

TEST(ToneCurves, ClampWhatIsNotInRange) {
    for (const ToneCurve& curve : {kSrgb, kPower}) {
        EXPECT_EQ(curve.toByte(1e30), 255);
        EXPECT_EQ(curve.toByte(std::numeric_limits<double>::infinity()), 255);
        EXPECT_EQ(curve.toByte(-0.5), 0);
        EXPECT_EQ(curve.toByte(-std::numeric_limits<double>::infinity()), 0);
        EXPECT_EQ(curve.toByte(std::numeric_limits<double>::quiet_NaN()), 0);
    }
}

/// Pixel filters that are negative in places make an alpha below 0 and above 1.
TEST(ToneMap, AlphaIsClampedToBytes) {
    Film film(3, 1);
    for (PixelStatistics& p : film.pixels)
        p.mean = glm::dvec3(0.5);
    const ByteImage image = toneMap(film, {}, std::array{-0.2f, 1.2f, 0.5f});
    EXPECT_EQ(image.alpha, (std::vector<uint8_t>{0, 255, 128}));
    const ToneCurve curve;
    EXPECT_EQ(image.pixel(0, 0)[0], 0);
    EXPECT_EQ(image.pixel(1, 0)[0], curve.toByte(0.5));
    EXPECT_EQ(image.pixel(2, 0)[0], curve.toByte(1));
}

} // namespace
} // namespace stromboli
