// FLIP against values that follow from its definition: constant pictures pass the filters
// unchanged, so that only the distance of two colours is left; a plain two-dimensional evaluation
// at single pixels shows the filters and the features.
#include "host/compare/flip.hpp"
#include "tests/compare/pictures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stromboli::compare {
namespace {

double flipOfConstants(const glm::dvec3& a, const glm::dvec3& b) {
    const std::vector<double> map = flipMap(constantPicture(6, 4, a), constantPicture(6, 4, b));
    for (const double value : map)
        EXPECT_NEAR(value, map.front(), 1e-9);
    return map.front();
}

TEST(Flip, OfEqualPicturesIsZero) {
    const Picture p = randomPicture(12, 9, 1);
    for (const double value : flipMap(p, p))
        EXPECT_EQ(value, 0);
    for (const double value : hdrFlipMap(p, p).map)
        EXPECT_EQ(value, 0);
}

TEST(Flip, OfGreenAndBlueIsOne) {
    EXPECT_NEAR(flipOfConstants({0, 1, 0}, {0, 0, 1}), 1, 1e-9);
}

/// The part of FLIP that maps a HyAB distance to [0, 1]. CIE L*a*b* of sRGB's green (87.737,
/// -86.185, 83.181) and blue (32.297, 79.188, -107.860), as Lindbloom publishes them, are the
/// farthest apart, once a* and b* are multiplied by L* / 100.
double mapped(double distance) {
    const double green[] = {87.737, 0.87737 * -86.185, 0.87737 * 83.181};
    const double blue[] = {32.297, 0.32297 * 79.188, 0.32297 * -107.860};
    const double most = green[0] - blue[0] + std::hypot(green[1] - blue[1], green[2] - blue[2]);
    const double e = std::pow(distance / most, 0.7);
    return e < 0.4 ? 0.95 * e / 0.4 : 0.95 + 0.05 * (e - 0.4) / 0.6;
}

TEST(Flip, OfGreysFollowsFromLightness) {
    // Greys differ in L* alone: 100 for white, 116 y^(1/3) - 16 for luminance y.
    EXPECT_NEAR(flipOfConstants(glm::dvec3(1), glm::dvec3(0)), mapped(100), 1e-4);
    const double lightness = 116 * std::cbrt(0.2) - 16;
    EXPECT_NEAR(flipOfConstants(glm::dvec3(1), glm::dvec3(0.2)), mapped(100 - lightness), 1e-4);
    EXPECT_NEAR(flipOfConstants(glm::dvec3(0.2), glm::dvec3(0)), mapped(lightness), 1e-4);
}

// ---- Plain evaluation of one pixel.

constexpr double kPi = std::numbers::pi;

/// The picture's colour, beyond the edges that of the nearest pixel.
const glm::dvec3& at(const Picture& p, int x, int y) {
    return p.rgb[size_t(std::clamp(y, 0, int(p.height) - 1)) * p.width +
                 size_t(std::clamp(x, 0, int(p.width) - 1))];
}

/// X, Y, Z over those of white (D65), by Lindbloom's matrix.
glm::dvec3 relativeXyz(const glm::dvec3& c) {
    return {(0.4124564 * c.x + 0.3575761 * c.y + 0.1804375 * c.z) / 0.95047,
            0.2126729 * c.x + 0.7151522 * c.y + 0.0721750 * c.z,
            (0.0193339 * c.x + 0.1191920 * c.y + 0.9503041 * c.z) / 1.08883};
}

/// L*, and a* and b* times L* / 100, of what the eye sees at a pixel. Red against green is
/// X - Y, blue against yellow Y - Z, each blurred by a filter of its own.
glm::dvec3 plainColor(const Picture& p, int x, int y, double ppd) {
    const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd));
    glm::dvec3 sum(0), weights(0);
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
            const auto g = [&](double a, double b) {
                return a * std::sqrt(kPi / b) *
                       std::exp(-kPi * kPi * (i * i + j * j) / (ppd * ppd) / b);
            };
            const glm::dvec3 w(g(1, 0.0047), g(1, 0.0053), g(34.1, 0.04) + g(13.5, 0.025));
            const glm::dvec3 t = relativeXyz(at(p, x + i, y + j));
            sum += w * glm::dvec3(t.y, t.x - t.y, t.y - t.z);
            weights += w;
        }
    const glm::dvec3 seen = sum / weights;
    const auto curve = [](double t) {
        return t > 216.0 / 24389 ? std::cbrt(t) : (t * 24389.0 / 27 + 16) / 116;
    };
    const double fx = curve(seen.x + seen.y), fy = curve(seen.x), fz = curve(seen.x - seen.z);
    const double lightness = 116 * fy - 16;
    return {lightness, 5 * lightness * (fx - fy), 2 * lightness * (fy - fz)};
}

/// Lengths of the edge and of the point response.
std::array<double, 2> plainFeatures(const Picture& p, int x, int y, double ppd) {
    const double sigma = 0.5 * 0.082 * ppd;
    const int radius = int(std::ceil(3 * sigma));
    std::array<double, 2> lengths{};
    for (const bool point : {false, true}) {
        double response[2] = {}, positive = 0, negative = 0;
        const auto weight = [&](int i, int j) { // derivative along i
            const double g = std::exp(-(i * i + j * j) / (2 * sigma * sigma));
            return point ? (i * i / (sigma * sigma) - 1) * g : -i * g;
        };
        for (int j = -radius; j <= radius; ++j)
            for (int i = -radius; i <= radius; ++i)
                (weight(i, j) > 0 ? positive : negative) += std::abs(weight(i, j));
        for (int j = -radius; j <= radius; ++j)
            for (int i = -radius; i <= radius; ++i) {
                const double alongX = weight(i, j), alongY = weight(j, i);
                const double value = relativeXyz(at(p, x + i, y + j)).y;
                response[0] += value * alongX / (alongX > 0 ? positive : negative);
                response[1] += value * alongY / (alongY > 0 ? positive : negative);
            }
        lengths[point] = std::hypot(response[0], response[1]);
    }
    return lengths;
}

double plainFlip(const Picture& a, const Picture& b, int x, int y, double ppd) {
    const glm::dvec3 d = plainColor(a, x, y, ppd) - plainColor(b, x, y, ppd);
    const double difference = std::abs(d.x) + std::hypot(d.y, d.z);
    const auto fa = plainFeatures(a, x, y, ppd), fb = plainFeatures(b, x, y, ppd);
    const double feature =
        std::sqrt(std::max(std::abs(fa[0] - fb[0]), std::abs(fa[1] - fb[1])) / std::numbers::sqrt2);
    return std::pow(mapped(difference), 1 - feature);
}

/// Colours that stay within sRGB when they are blurred: far from its edges.
Picture softNoise(uint32_t width, uint32_t height, unsigned seed) {
    Picture p = randomPicture(width, height, seed, 0.2);
    for (glm::dvec3& c : p.rgb)
        c = 0.3 + 0.4 * glm::min(c, glm::dvec3(1));
    return p;
}

TEST(Flip, OfNoiseIsItsDefinition) {
    const Picture a = softNoise(31, 23, 2);
    Picture b = softNoise(31, 23, 3), edge = a;
    for (size_t i = 0; i < edge.rgb.size(); ++i) // an edge that `a` has not
        edge.rgb[i] = i % 31 < 12 ? glm::dvec3(0.3, 0.4, 0.6) : glm::dvec3(0.7, 0.6, 0.4);
    for (const double ppd : {kFlipPixelsPerDegree, 25.0})
        for (const Picture& other : {b, edge}) {
            const std::vector<double> map = flipMap(a, other, ppd);
            for (const auto& [x, y] : {std::pair{0, 0}, {12, 11}, {15, 7}, {30, 22}})
                EXPECT_NEAR(map[size_t(y * 31 + x)], plainFlip(a, other, x, y, ppd), 1e-4);
        }
}

TEST(HdrFlip, ExposuresReachFromTheBrightestToTheMedian) {
    Picture p = constantPicture(5, 1, glm::dvec3(1));
    p.rgb[0] = glm::dvec3(32);
    p.rgb[1] = glm::dvec3(0.01);
    const HdrFlip result = hdrFlipMap(p, p);
    EXPECT_NEAR(result.stopStops - result.startStops, 5, 1e-9); // log2(32 / 1)
    EXPECT_EQ(result.exposures, 5);
    // The brightest pixel at the first exposure is 0.85 of white through the curve
    // x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), x after the factor 0.6.
    const double x = 0.6 * 32 * std::exp2(result.startStops);
    EXPECT_NEAR(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.85, 1e-9);
}

TEST(HdrFlip, SeesWhatFlipCutsOff) {
    const Picture a = constantPicture(8, 8, glm::dvec3(4)),
                  b = constantPicture(8, 8, glm::dvec3(8));
    EXPECT_EQ(meanOf(flipMap(a, b)), 0);
    EXPECT_GT(meanOf(hdrFlipMap(a, b).map), 0.1);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfRadiance) {
    const Picture a = randomPicture(16, 12, 4), b = randomPicture(16, 12, 5);
    EXPECT_NEAR(meanOf(hdrFlipMap(scaled(a, 1024), scaled(b, 1024)).map),
                meanOf(hdrFlipMap(a, b).map), 1e-9);
}

TEST(HdrFlip, OfBlackPicturesIsZero) {
    const Picture black(4, 4);
    EXPECT_EQ(meanOf(hdrFlipMap(black, black).map), 0);
}

} // namespace
} // namespace stromboli::compare
