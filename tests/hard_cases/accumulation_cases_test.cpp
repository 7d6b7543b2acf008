// Hard cases 55 to 58: variances, and adaptive sampling of pixels whose light is rare. Pixels are
// made up here, so that thousands of renders cost nothing; tests/render has the same on the device.
#include "host/render/sampling_plan.hpp"
#include "host/render/sampling_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace stromboli::test {
namespace {

/// Mean and variance by sum and sum of squares, in float.
struct NaiveVariance {
    float sum = 0, squares = 0, count = 0;
    void add(float x) { sum += x, squares += x * x, ++count; }
    float variance() const { return (squares - sum * sum / count) / (count - 1); }
};

TEST(HardCases, C55_VarianceOfSmallDeviations) {
    std::mt19937_64 engine(55);
    std::vector<double> values;
    for (int i = 0; i < 10000; ++i)
        values.push_back(1e4 + 1e-2 * (i % 2 ? 1 : -1));
    const double expected = 1e-4 * 10000 / 9999;
    PixelStatistics whole;
    NaiveVariance naive;
    for (const double x : values) {
        whole.add(glm::dvec3(x));
        naive.add(float(x));
    }
    EXPECT_NEAR(whole.variance().x / expected, 1, 1e-6);
    for (int trial = 0; trial < 100; ++trial) { // random splits, merged
        PixelStatistics merged;
        for (size_t begin = 0; begin < values.size();) {
            const size_t end = std::min<size_t>(begin + engine() % 500, values.size());
            PixelStatistics part;
            for (size_t i = begin; i < end; ++i)
                part.add(glm::dvec3(values[i]));
            merged.merge(part);
            begin = end;
        }
        EXPECT_EQ(merged.count, whole.count);
        EXPECT_NEAR(merged.variance().x / expected, 1, 1e-6);
        EXPECT_NEAR(merged.mean.x, whole.mean.x, 1e-9);
    }
    EXPECT_FALSE(std::abs(naive.variance() / expected - 1) < 0.1)
        << "negative control: cancellation";
}

/// A sample of a pixel, given a random engine.
using Sampler = std::function<double(uint32_t pixel, std::mt19937_64&)>;

/// Renders made-up pixels as the sampling plan wants them.
Film renderMadeUp(const RenderSettings& s, const Sampler& sampler, uint64_t seed) {
    const SamplingPlan plan(s.budget);
    Film film(s.area);
    std::vector<std::mt19937_64> engines;
    for (uint32_t i = 0; i < film.pixels.size(); ++i)
        engines.emplace_back(seed * 1000003 + i);
    for (auto pass = plan.next(film); !pass.empty(); pass = plan.next(film))
        for (const PixelTarget& t : pass)
            while (film.pixels[t.pixel].taken() < t.samples)
                film.pixels[t.pixel].add(glm::dvec3(sampler(t.pixel, engines[t.pixel])));
    return film;
}

RenderSettings adaptive(uint32_t side, uint32_t samples, bool published) {
    RenderSettings s;
    s.area.width = s.area.height = side;
    s.budget.mostSamplesPerPixel = samples;
    s.budget.adaptive = {true, Adaptive::Rule::Neighbourhood, 32, 0.1};
    if (published)
        s.budget.adaptive.rule =
            Adaptive::Rule::PerChannel; // that renderer's rule: stop where 1.96 sigma is within the
                                        // tolerance, 0
                                        // <= 0 too
    return s;
}

double meanOf(const Film& film) {
    double sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += p.mean.x;
    return sum / double(film.pixels.size());
}

/// Light that one sample in 200 meets. The default rule loses it in no pixel, the published one in
/// most.
TEST(HardCases, C56_RareLightIsNotLost) {
    const Sampler rare = [](uint32_t, std::mt19937_64& engine) {
        return engine() % 200 == 0 ? 200.0 : 0.0; // mean 1, sigma 14
    };
    size_t black = 0, naiveBlack = 0;
    const uint32_t kSamples = 4096;
    double mean = 0;
    constexpr int kSeeds = 8, kSide = 12;
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
        const Film film = renderMadeUp(adaptive(kSide, kSamples, false), rare, seed);
        const Film naive = renderMadeUp(adaptive(kSide, kSamples, true), rare, seed);
        for (size_t i = 0; i < film.pixels.size(); ++i)
            black += film.pixels[i].mean.x == 0, naiveBlack += naive.pixels[i].mean.x == 0;
        mean += meanOf(film) / kSeeds;
    }
    EXPECT_EQ(black, 0u);
    const double sigma = std::sqrt(199.0 / kSamples / (kSide * kSide * kSeeds));
    EXPECT_NEAR(mean, 1, 3 * sigma);
    EXPECT_GT(naiveBlack, kSeeds * kSide * kSide / 2) << "negative control: 0 <= 0 stops for ever";
}

/// A constant pixel stops at the fewest samples, but for those beside a noisy one, which go on with
/// it; no pixel has more than the most; and the samples counted in the film are those that were
/// traced.
TEST(HardCases, C57_StoppingAndGoingOn) {
    constexpr uint32_t kSide = 9, kMost = 1000, kNoisy = 4 * kSide + 4;
    const Film film = renderMadeUp(
        adaptive(kSide, kMost, false),
        [](uint32_t pixel, std::mt19937_64& engine) {
            return pixel == kNoisy ? double(engine() % 2 ? 30 : 0) : 0.5;
        },
        57);
    EXPECT_EQ(film.at(0, 0).taken(), SamplingPlan::kMinimumSamples);
    EXPECT_EQ(film.at(4, 4).taken(), kMost);
    EXPECT_GT(film.at(5, 5).taken(), SamplingPlan::kMinimumSamples) << "taken up by its neighbour";
    for (const PixelStatistics& p : film.pixels)
        EXPECT_LE(p.taken(), kMost);
    const Film naive = renderMadeUp(
        adaptive(kSide, kMost, true), [](uint32_t, std::mt19937_64&) { return 0.5; }, 57);
    EXPECT_LT(naive.at(0, 0).taken(), SamplingPlan::kMinimumSamples)
        << "negative control: no least number of samples";
}

/// The mean over 64 seeds against what it is, for three kinds of noise. Optional stopping favours
/// pixels that look calm because they have missed their light, so that the bias is towards the
/// dark.
TEST(HardCases, C58_BiasOfStopping) {
    struct Noise {
        const char* name;
        Sampler sampler;
        double mean;
    };
    const std::vector<Noise> kinds = {
        {"even", [](uint32_t, std::mt19937_64& e) { return double(e() >> 11) * 0x1p-53; }, 0.5},
        {"one in eight", [](uint32_t, std::mt19937_64& e) { return e() % 8 == 0 ? 8.0 : 0.0; }, 1},
        {"one in fifty", [](uint32_t, std::mt19937_64& e) { return e() % 50 == 0 ? 50.0 : 0.0; },
         1}};
    double naiveWorst = 0;
    for (const Noise& noise : kinds) {
        double sum = 0, squares = 0, naive = 0;
        constexpr int kSeeds = 64;
        for (uint64_t seed = 0; seed < kSeeds; ++seed) {
            const double mean = meanOf(renderMadeUp(adaptive(8, 4096, false), noise.sampler, seed));
            sum += mean, squares += mean * mean;
            naive += meanOf(renderMadeUp(adaptive(8, 4096, true), noise.sampler, seed));
        }
        const double mean = sum / kSeeds;
        const double sigma = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
        std::printf("%s: bias %+.2f %% (standard error %.2f %%)\n", noise.name,
                    100 * (mean / noise.mean - 1), 100 * sigma / noise.mean);
        EXPECT_LT(std::abs(mean / noise.mean - 1), 0.01 + 3 * sigma / noise.mean) << noise.name;
        naiveWorst = std::max(naiveWorst, std::abs(naive / kSeeds / noise.mean - 1));
    }
    EXPECT_GT(naiveWorst, 0.03) << "negative control: the published rule";
}

} // namespace
} // namespace stromboli::test
