// Stop rules, and where they send samples, against samples of known mean and variance.
#include "host/render/sampling_plan.hpp"
#include "tests/render/drawn_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stromboli {
namespace {

using namespace test;

/// Over seeds, the relMSE of a stop rule times its samples, over that of uniform sampling: the
/// noise is as 1 / samples, so that this is the ratio at an equal number of samples.
double efficiencyRatio(const Draw& draw, const StopRule& stop, uint32_t meanSamples = 0) {
    double ruled = 0, uniform = 0;
    for (uint32_t seed = 0; seed < 8; ++seed) {
        RenderSettings s = settingsOf(1u << 20);
        s.budget.stop = stop;
        s.budget.meanSamplesPerPixel = meanSamples;
        const Rendered a = renderDrawn(draw, s, seed);
        ruled += trueRelativeError(a.film) * double(samplesOf(a.film));
        const Rendered b = renderDrawn(draw, settingsOf(64), 100 + seed);
        uniform += trueRelativeError(b.film) * double(samplesOf(b.film));
    }
    return ruled / uniform;
}

TEST(StopRule, NoiseIsWhatWasAskedFor) {
    for (double noise : {0.1, 0.03}) {
        RenderSettings s = settingsOf(1u << 20);
        s.budget.stop.noise = noise;
        const Rendered r = renderDrawn(uneven, s, 1);
        EXPECT_LE(r.outcome.noise.most, noise);
        EXPECT_LT(std::sqrt(trueRelativeError(r.film)), noise);
        EXPECT_GT(std::sqrt(trueRelativeError(r.film)), 0.6 * noise); // the range is narrow
    }
}

TEST(StopRule, UnevenNoiseTakesFewerSamples) {
    // In theory (sum of sigmas)^2 / sum of squared sigmas: 0.2 for these.
    EXPECT_LT(efficiencyRatio(uneven, {.noise = 0.05}), 1 / 1.3);
}

TEST(StopRule, EvenNoiseLosesLessThanFivePercent) {
    EXPECT_LT(efficiencyRatio(even, {.noise = 0.08}), 1.05);
}

TEST(StopRule, MeanSamplesAreSpread) {
    EXPECT_LT(efficiencyRatio(uneven, {}, 64), 1 / 1.3);
    EXPECT_LT(efficiencyRatio(even, {}, 64), 1.05);
}

TEST(StopRule, SamplesAreEvenWhereSpreadingPromisesLittle) {
    const auto counts = [](const Draw& draw, uint32_t mean) {
        RenderSettings s = settingsOf(1u << 20);
        s.budget.meanSamplesPerPixel = mean;
        const Film film = renderDrawn(draw, s, 1).film;
        const auto [least, most] = std::ranges::minmax(film.pixels, {}, &PixelStatistics::taken);
        return std::pair(least.taken(), most.taken());
    };
    // Half of the pixels with twice the variance: spread samples would have 0.97 of the error.
    const Draw mild = [](uint32_t pixel, Random& random) {
        return gamma(pixel % 2 == 0 ? 0.5 : 1.0, random);
    };
    for (const uint32_t mean : {16u, 64u, 100u}) {
        EXPECT_EQ(counts(even, mean), std::pair(mean, mean));
        EXPECT_EQ(counts(mild, mean), std::pair(mean, mean));
        EXPECT_LT(counts(uneven, mean).first, counts(uneven, mean).second);
    }
}

TEST(StopRule, MeanSamplesAreTaken) {
    for (const Draw& draw : {Draw(uneven), Draw(even), Draw([](uint32_t, Random&) { return 0.0; })})
        for (uint32_t mean : {16u, 17u, 40u, 64u, 1000u}) {
            RenderSettings s = settingsOf(1u << 20);
            s.budget.meanSamplesPerPixel = mean;
            const uint64_t asked = samplesAtMost(s.area, s.budget),
                           taken = samplesOf(renderDrawn(draw, s, 1).film);
            EXPECT_LE(taken, asked);
            EXPECT_GE(taken, asked - asked / 64 - 2 * mean) << mean; // what is not worth a pass
        }
}

TEST(StopRule, MeanSamplesAreThoseOfTheCrop) {
    RenderSettings s = settingsOf(1u << 20);
    s.area.crop = {5, 7, 30, 20};
    s.budget.meanSamplesPerPixel = 40;
    EXPECT_EQ(samplesAtMost(s.area, s.budget), 30u * 20 * 40);
    EXPECT_NEAR(double(samplesOf(renderDrawn(uneven, s, 1).film)), 30 * 20 * 40, 30 * 20);
}

TEST(StopRule, RareLightIsNotLost) {
    // Black but for one sample in 200: pixels that have not met the light look finished.
    const Draw rare = [](uint32_t pixel, Random& random) {
        if (pixel % kSide < kSide / 2) return gamma(0.2, random);
        return std::bernoulli_distribution(0.005)(random) ? 200.0 : 0.0;
    };
    double sum = 0, squares = 0;
    constexpr int kSeeds = 12;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        RenderSettings s = settingsOf(4096);
        s.budget.stop.noise = 0.25;
        const Rendered r = renderDrawn(rare, s, seed);
        double mean = 0;
        for (const PixelStatistics& p : r.film.pixels)
            mean += p.mean.x / double(r.film.pixels.size());
        sum += mean, squares += mean * mean;
    }
    const double mean = sum / kSeeds;
    const double sigma = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
    EXPECT_LT(sigma, 0.02);
    EXPECT_LT(std::abs(mean - 1), 4.5 * sigma); // one false alarm in 150,000
}

TEST(StopRule, PixelsThatLookFinishedGetTheirShare) {
    const Draw halfConstant = [](uint32_t pixel, Random& random) {
        return pixel % kSide < kSide / 2 ? 1.0 : gamma(1.0, random);
    };
    RenderSettings s = settingsOf(1u << 20);
    s.budget.meanSamplesPerPixel = 1024;
    const Film film = renderDrawn(halfConstant, s, 1).film;
    for (const PixelStatistics& p : film.pixels)
        EXPECT_GE(p.taken(), NoisePlan::kLeastShare * 1024);
}

TEST(StopRule, SpreadingDoesNotDarken) {
    // A quarter of the picture has rare light, one sample in 50, that a pixel may meet or not in
    // its first samples: the case in which samples that decide about their own number do harm.
    const Draw caustic = [](uint32_t pixel, Random& random) {
        if (pixel % kSide < 3 * kSide / 4) return gamma(0.5, random);
        return std::bernoulli_distribution(0.02)(random) ? 50.0 : 0.0;
    };
    constexpr int kSeeds = 400;
    double sum = 0, squares = 0;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        RenderSettings s = settingsOf(1u << 20);
        s.budget.meanSamplesPerPixel = 64;
        double mean = 0;
        for (const PixelStatistics& p : renderDrawn(caustic, s, seed).film.pixels)
            mean += p.mean.x / (kSide * kSide);
        sum += mean, squares += mean * mean;
    }
    const double mean = sum / kSeeds;
    const double sigma = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
    EXPECT_LT(sigma, 0.0006);
    EXPECT_LT(std::abs(mean - 1), 0.001 + 3 * sigma);
}

TEST(StopRule, MostSamplesAreKept) {
    RenderSettings s = settingsOf(100);
    s.budget.stop.noise = 1e-6;
    const Rendered r = renderDrawn(even, s, 1);
    for (const PixelStatistics& p : r.film.pixels)
        EXPECT_EQ(p.taken(), 100u);
    EXPECT_GT(r.outcome.noise.least, 1e-6);
}

TEST(StopRule, BlackPicturesEnd) {
    RenderSettings s = settingsOf(1u << 20);
    s.budget.stop.noise = 0.01;
    const Rendered r = renderDrawn([](uint32_t, Random&) { return 0.0; }, s, 1);
    // A light that one sample in a million meets is ruled out in 95 of 100 renders: three million
    // samples, and at most the pass that reaches them.
    EXPECT_GE(samplesOf(r.film), 3'000'000u);
    EXPECT_LT(samplesOf(r.film), 6'000'000u);
    EXPECT_EQ(r.outcome.noise.unknown, PictureNoise::Unknown::Black);
}

TEST(StopRule, FirstPathsAreThoseOfBranchesToo) {
    for (const auto& [branches, samples] : {std::pair(1u, 8u), {2u, 4u}, {4u, 4u}, {9u, 4u}}) {
        NoiseEstimate estimate;
        const auto pass = NoisePlan(1024, branches).next(Film(kSide, kSide), estimate, 1u << 30, 0);
        ASSERT_EQ(pass.size(), kSide * kSide);
        for (const PixelTarget& t : pass)
            EXPECT_EQ(t.samples, samples);
    }
}

/// When the time is up, no part of the picture is left out.
TEST(NoisePlan, CoversThePictureFromCoarseToFine) {
    const NoisePlan plan(1024, 1, NoisePlan::Beginning::CoarseToFine);
    const NoiseEstimate estimate;
    Film film(21, 13);
    for (const uint32_t step : {8u, 4u, 2u, 1u}) {
        for (const PixelTarget& t : plan.next(film, estimate, 1, 0)) {
            EXPECT_EQ(t.samples, 1u);
            EXPECT_EQ(film.pixels[t.pixel].count, 0u);
            film.pixels[t.pixel].count = 1;
        }
        for (uint32_t y = 0; y < film.height; ++y)
            for (uint32_t x = 0; x < film.width; ++x)
                ASSERT_EQ(film.at(x, y).count, x % step == 0 && y % step == 0) << step;
    }
    for (const uint32_t samples : {2u, 4u, 8u}) { // then all alike, up to the usual first pass
        const auto pass = plan.next(film, estimate, 1, 0);
        ASSERT_EQ(pass.size(), film.pixels.size());
        for (const PixelTarget& t : pass) {
            EXPECT_EQ(t.samples, samples);
            film.pixels[t.pixel].count = samples;
        }
    }
}

TEST(StopRule, TimeEndsARender) {
    RenderSettings s = settingsOf(1u << 24);
    s.budget.stop.seconds = 0.05;
    const Rendered r = renderDrawn(even, s, 1);
    EXPECT_TRUE(r.outcome.outOfTime || samplesOf(r.film) > 0);
    EXPECT_LT(samplesOf(r.film), uint64_t(1) << 34); // not all
}

TEST(NoisePlan, NoStepLeftOutIsWorthMore) {
    DrawnBackend backend(uneven, 3);
    const Film film = render(backend, settingsOf(16));
    NoiseEstimate estimate;
    estimate.update(film);
    const std::vector<double> variance = estimate.relativeVariance(film);
    const auto pass = NoisePlan(1024).next(film, estimate, 9999, 0);
    std::vector<uint32_t> target(film.pixels.size(), 16);
    uint64_t spent = 0;
    for (const PixelTarget& t : pass)
        target[t.pixel] = t.samples, spent += t.samples - 16;
    EXPECT_LE(spent, 9999u);
    EXPECT_GT(spent + 32, 9999u);
    // From 16 to 24, 32, 48, 64: n and the next.
    const auto next = [](uint32_t n) { return n % 3 == 0 ? n / 3 * 4 : n / 2 * 3; };
    double leastTaken = 1e300, mostLeft = 0;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        for (uint32_t n = 16; n < target[pixel]; n = next(n))
            leastTaken = std::min(leastTaken, variance[pixel] / (double(n) * next(n)));
        const uint32_t n = target[pixel];
        if (n < 64) mostLeft = std::max(mostLeft, variance[pixel] / (double(n) * next(n)));
    }
    EXPECT_GE(leastTaken, mostLeft);
}

TEST(NoisePlan, TheSameFilmGivesTheSamePass) {
    DrawnBackend backend(uneven, 3);
    const Film film = render(backend, settingsOf(16));
    const NoisePlan plan(1024);
    NoiseEstimate estimate;
    estimate.update(film);
    const auto a = plan.next(film, estimate, 20000, 0), b = plan.next(film, estimate, 20000, 0);
    ASSERT_EQ(a.size(), b.size());
    ASSERT_FALSE(a.empty());
    uint64_t spent = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].pixel, b[i].pixel);
        EXPECT_TRUE(a[i].samples == 24 || a[i].samples == 32 || a[i].samples == 48 ||
                    a[i].samples == 64);
        spent += a[i].samples - film.pixels[a[i].pixel].taken();
    }
    EXPECT_LE(spent, 20000u);
}

} // namespace
} // namespace stromboli