// The estimate of a picture's noise against samples of known mean and variance.
#include "tests/render/drawn_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace stromboli {
namespace {

using namespace test;

TEST(NoiseEstimate, IsTheErrorOfIndependentSamples) {
    // 8 seeds of 2304 pixels; relMSE's own relative sigma is about sqrt(2 / 18432) = 1 %.
    double estimated = 0, error = 0;
    for (uint32_t seed = 0; seed < 8; ++seed) {
        const Rendered r = renderDrawn(even, settingsOf(64), seed);
        estimated += r.outcome.noise.estimate * r.outcome.noise.estimate;
        error += trueRelativeError(r.film);
    }
    EXPECT_NEAR(estimated / error, 1, 0.08); // 4 sigma of the ratio with gamma's excess kurtosis
}

TEST(NoiseEstimate, SeesTheGainOfSamplesThatFillGaps) {
    // Means that are off by n^-0.75, as with Sobol points, and right in their variance: Welford's
    // variance over n would say 8 times the squared error at 64.
    constexpr double kSigma = 0.5;
    NoiseEstimate estimate;
    Film film(2, 2);
    const auto setTo = [&](uint32_t n) {
        const double off = kSigma * std::pow(double(n), -0.75);
        for (size_t i = 0; i < 4; ++i) {
            film.pixels[i].count = n;
            // Errors of doublings are independent enough: each has its own sign.
            film.pixels[i].mean = glm::dvec3(1 + ((i + n / 32) % 2 ? off : -off));
            film.pixels[i].m2 = glm::dvec3(kSigma * kSigma * (n - 1));
        }
        estimate.update(film);
    };
    setTo(32);
    setTo(64);
    const double welford = kSigma / std::sqrt(64.0);
    EXPECT_LT(estimate.picture(film).estimate, welford);
    EXPECT_GT(estimate.picture(film).estimate, kSigma * std::pow(64.0, -0.75));
}
/// Pixel by pixel from the definition.
TEST(NoiseEstimate, JudgesAPixelByItsNeighbours) {
    RenderSettings s = settingsOf(16);
    s.area.crop = {3, 5, 40, 30};
    DrawnBackend backend(uneven, 3);
    const Film film = render(backend, s);
    NoiseEstimate estimate;
    estimate.update(film); // the first: by the samples' variances
    const std::vector<double> found = estimate.relativeVariance(film);
    double pictureMean = 0;
    for (const PixelStatistics& p : film.pixels)
        pictureMean += p.mean.x / double(film.pixels.size());
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        double variance = 0, mean = 0;
        int count = 0;
        for (int dy = -3; dy <= 3; ++dy)
            for (int dx = -3; dx <= 3; ++dx) {
                const int x = int(pixel % 40) + dx, y = int(pixel / 40) + dy;
                if (x < 0 || y < 0 || x >= 40 || y >= 30 || (dx == 0 && dy == 0)) continue;
                const PixelStatistics& p = film.at(uint32_t(x), uint32_t(y));
                variance += p.variance().x, mean += p.mean.x, ++count;
            }
        variance /= count, mean /= count;
        const double expected = variance / (mean * mean + 0.01 * pictureMean * pictureMean);
        ASSERT_NEAR(found[pixel] / expected, 1, 1e-9) << pixel;
    }
}

/// Where samples fill each other's gaps, as Sobol points do at edges, the samples' variance says
/// more than is true; what passes change does not.
TEST(NoiseEstimate, JudgesByWhatPassesChange) {
    constexpr double kSigma = 0.5;
    Film film(kSide, kSide);
    NoiseEstimate estimate;
    const auto setTo = [&](uint32_t n) {
        Random random{n};
        for (size_t i = 0; i < film.pixels.size(); ++i) {
            // The left half's errors fall as n^-1/2, the right half's are a tenth of that.
            const double share = i % kSide < kSide / 2 ? 1 : 0.1;
            const double sign = random() >> 63 ? -1 : 1;
            film.pixels[i].count = n;
            film.pixels[i].mean = glm::dvec3(1 + sign * share * kSigma / std::sqrt(double(n)));
            film.pixels[i].m2 = glm::dvec3(kSigma * kSigma * (n - 1));
        }
        estimate.update(film);
    };
    setTo(32), setTo(64);
    const std::vector<double> found = estimate.relativeVariance(film);
    double left = 0, right = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        if (i % kSide < kSide / 2 - 4) left += found[i];
        if (i % kSide > kSide / 2 + 4) right += found[i];
    }
    EXPECT_NEAR(right / left, 0.01, 0.003);
}

} // namespace
} // namespace stromboli
