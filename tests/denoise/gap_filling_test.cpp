// How much of what two halves of the samples say is error.
#include "host/denoise/gap_filling.hpp"

#include "host/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

/// The difference and the samples' variance of a mean whose variance falls as n^-b.
double ratioOf(double b, double samplesInHalf) {
    const double half = std::pow(samplesInHalf, -b), both = std::pow(2 * samplesInHalf, -b);
    return (half - both) / (1 / (2 * samplesInHalf));
}

TEST(GapFilling, TheShareFollowsFromHowTheVarianceFalls) {
    for (const double b : {1.0, 1.3, 1.5, 2.0, 2.9})
        for (const double n : {4.0, 32.0, 1000.0}) {
            const double half = std::pow(n, -b), both = std::pow(2 * n, -b);
            EXPECT_NEAR(denoise::shareOfError(ratioOf(b, n), n), both / (half - both), 1e-6);
        }
    EXPECT_NEAR(denoise::shareOfError(5, 16), 1, 1e-6); // more than samples explain: chance
    EXPECT_NEAR(denoise::shareOfError(0, 16), 1.0 / 7, 1e-6);
}

/// A film of 24 x 24 pixels, each with samples of a mean, in two halves.
struct Halves {
    Film film{24, 24};
    std::vector<glm::dvec3> squaredErrors;
};

/// value: of sample i of so many.
template <class Value>
Halves halvesOf(uint32_t samples, const Value& value) {
    Halves h;
    for (PixelStatistics& p : h.film.pixels) {
        for (uint32_t i = 0; i < samples / 2; ++i)
            p.add(glm::dvec3(value(i, samples)));
        const glm::dvec3 before = p.mean;
        for (uint32_t i = samples / 2; i < samples; ++i)
            p.add(glm::dvec3(value(i, samples)));
        h.squaredErrors.push_back((p.mean - before) * (p.mean - before));
    }
    return h;
}

double meanOf(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values)
        sum += value;
    return sum / double(values.size());
}

/// 81 pixels tell the ratio to 16 %; what is above 1 counts as 1, so that the mean is below.
TEST(GapFilling, IndependentSamplesHaveNoneToFill) {
    Random random(3);
    const Halves h = halvesOf(32, [&](uint32_t, uint32_t) { return double(random.uniform()); });
    const double share = meanOf(denoise::sharesOfErrors(h.film, h.squaredErrors));
    EXPECT_GT(share, 0.85);
    EXPECT_LE(share, 1);
}

/// Each half takes one sample of each stratum, those of the second half the other half of it: the
/// error of both together is a quarter of what they differ by and less.
TEST(GapFilling, StrataThatHalvesShare) {
    Random random(4);
    std::vector<bool> firstIsLow(16);
    const Halves h = halvesOf(32, [&](uint32_t i, uint32_t samples) {
        const uint32_t stratum = i % (samples / 2);
        if (i < samples / 2) firstIsLow[stratum] = random.below(2) == 0;
        const bool isLow = firstIsLow[stratum] == (i < samples / 2);
        return (stratum + 0.5 * (isLow ? 0 : 1) + 0.5 * double(random.uniform())) /
               double(samples / 2);
    });
    EXPECT_LT(meanOf(denoise::sharesOfErrors(h.film, h.squaredErrors)), 0.4);
}

} // namespace
} // namespace stromboli
