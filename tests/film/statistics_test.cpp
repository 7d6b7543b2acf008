#include "host/film/film.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace stromboli {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PixelStatistics statisticsOf(const std::vector<glm::dvec3>& samples) {
    PixelStatistics statistics;
    for (const glm::dvec3& sample : samples)
        statistics.add(sample);
    return statistics;
}

/// Mean and variance of a channel by their definitions, in extended precision.
struct TwoPass {
    long double mean = 0, variance = 0;

    TwoPass(const std::vector<glm::dvec3>& samples, int channel) {
        for (const glm::dvec3& sample : samples)
            mean += sample[channel];
        mean /= samples.size();
        for (const glm::dvec3& sample : samples)
            variance += (sample[channel] - mean) * (sample[channel] - mean);
        variance /= samples.size() - 1;
    }
};

std::vector<glm::dvec3> randomSamples(size_t count, double centre, double spread) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(centre - spread, centre + spread);
    std::vector<glm::dvec3> samples(count);
    for (glm::dvec3& sample : samples)
        sample = {uniform(random), uniform(random), uniform(random)};
    return samples;
}

/// Rounding errors of the recurrences grow like count * 2^-53 * centre in the mean, and like
/// that number times the spread in the variance.
void expectAgrees(const PixelStatistics& statistics, const std::vector<glm::dvec3>& samples,
                  double centre, double spread) {
    const double rounding = double(samples.size()) * 0x1p-53 * centre;
    ASSERT_EQ(statistics.count, samples.size());
    for (int channel = 0; channel < 3; ++channel) {
        const TwoPass exact(samples, channel);
        EXPECT_NEAR(statistics.mean[channel], double(exact.mean), rounding);
        EXPECT_NEAR(statistics.variance()[channel], double(exact.variance), 2 * rounding * spread);
        EXPECT_NEAR(statistics.varianceOfMean()[channel],
                    double(exact.variance) / double(samples.size()),
                    2 * rounding * spread / double(samples.size()));
    }
}

TEST(Statistics, ThreeNumbersByHand) {
    const PixelStatistics statistics = statisticsOf({{1, 0, 2}, {2, 0, 4}, {6, 0, 0}});
    EXPECT_EQ(statistics.mean, glm::dvec3(3, 0, 2));
    EXPECT_EQ(statistics.variance(), glm::dvec3(7, 0, 4));
    EXPECT_DOUBLE_EQ(statistics.varianceOfMean().x, 7.0 / 3);
}

TEST(Statistics, FewerThanTwoSamplesHaveNoVariance) {
    EXPECT_EQ(PixelStatistics().variance(), glm::dvec3(0));
    EXPECT_EQ(PixelStatistics().varianceOfMean(), glm::dvec3(0));
    EXPECT_EQ(statisticsOf({{5, 6, 7}}).variance(), glm::dvec3(0));
    EXPECT_EQ(statisticsOf({{5, 6, 7}}).mean, glm::dvec3(5, 6, 7));
}

TEST(Statistics, AgreeWithTheDefinitions) {
    expectAgrees(statisticsOf(randomSamples(10'000, 1, 1)), randomSamples(10'000, 1, 1), 1, 1);
}

/// Sum and sum of squares would have 1e8 +- 1e-4 to subtract and lose the variance altogether.
TEST(Statistics, SmallSpreadAboutALargeValue) {
    const auto samples = randomSamples(10'000, 1e4, 1e-2);
    const PixelStatistics statistics = statisticsOf(samples);
    expectAgrees(statistics, samples, 1e4, 1e-2);
    EXPECT_NEAR(statistics.variance().x, 1e-4 / 3, 2e-6); // uniform: (2 spread)^2 / 12
}

TEST(Statistics, TenMillionEqualSamplesStayExact) {
    PixelStatistics statistics;
    for (int i = 0; i < 10'000'000; ++i)
        statistics.add({0.1, 0.5, 1e4 + 0.1});
    EXPECT_EQ(statistics.count, 10'000'000u);
    EXPECT_EQ(statistics.mean, glm::dvec3(0.1, 0.5, 1e4 + 0.1));
    EXPECT_EQ(statistics.variance(), glm::dvec3(0));
}

class MergedSplits : public testing::TestWithParam<double> {};

TEST_P(MergedSplits, AgreeWithTheDefinitions) {
    const double centre = GetParam(), spread = centre == 1 ? 1 : 1e-2;
    const auto samples = randomSamples(5'000, centre, spread);
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 100; ++trial) {
        PixelStatistics whole;
        for (size_t begin = 0; begin < samples.size();) {
            const size_t size = std::min<size_t>(random() % 400, samples.size() - begin);
            whole.merge(statisticsOf({samples.begin() + begin, samples.begin() + begin + size}));
            begin += size;
        }
        expectAgrees(whole, samples, centre, spread);
    }
}

INSTANTIATE_TEST_SUITE_P(Centres, MergedSplits, testing::Values(1.0, 1e4), test::NamedByValue{});

TEST(Statistics, MergingWithNothingChangesNothing) {
    const PixelStatistics some = statisticsOf({{1, 2, 3}, {2, 3, 5}, {kNaN, 0, 0}});
    PixelStatistics left = some, right;
    left.merge({});
    right.merge(some);
    for (const PixelStatistics& merged : {left, right}) {
        EXPECT_EQ(merged.count, 2u);
        EXPECT_EQ(merged.rejected, 1u);
        EXPECT_EQ(merged.firstRejected, 2u);
        EXPECT_EQ(merged.mean, some.mean);
        EXPECT_EQ(merged.m2, some.m2);
    }
}

class Rejection : public testing::TestWithParam<double> {};

TEST_P(Rejection, LeavesTheMeanAloneAndIsCounted) {
    for (int channel = 0; channel < 3; ++channel) {
        PixelStatistics statistics = statisticsOf({{1, 1, 1}, {3, 3, 3}});
        glm::dvec3 bad(2);
        bad[channel] = GetParam();
        statistics.add(bad);
        statistics.add({2, 2, 2});
        statistics.add(bad);
        EXPECT_EQ(statistics.count, 3u);
        EXPECT_EQ(statistics.rejected, 2u);
        EXPECT_EQ(statistics.taken(), 5u);
        EXPECT_EQ(statistics.firstRejected, 2u);
        EXPECT_EQ(statistics.mean, glm::dvec3(2));
        EXPECT_EQ(statistics.variance(), glm::dvec3(1));
    }
}

INSTANTIATE_TEST_SUITE_P(Values, Rejection,
                         testing::Values(kNaN, -kNaN, kInfinity, -kInfinity, -1e-30, -5.0),
                         test::NamedByValue{});

TEST(Statistics, ZeroAndNegativeZeroAreRadiances) {
    const PixelStatistics statistics = statisticsOf({{0, -0.0, 0}, {0, 0, -0.0}});
    EXPECT_EQ(statistics.count, 2u);
    EXPECT_EQ(statistics.rejected, 0u);
    EXPECT_EQ(statistics.firstRejected, 0xFFFFFFFFu);
}

TEST(Statistics, MergeCountsTheFirstRejectedSampleFromTheBeginning) {
    PixelStatistics whole = statisticsOf({{1, 1, 1}, {1, 1, 1}});
    whole.merge(statisticsOf({{1, 1, 1}, {kNaN, 1, 1}, {kNaN, 1, 1}}));
    EXPECT_EQ(whole.firstRejected, 3u);
    whole.merge(statisticsOf({{kNaN, 1, 1}}));
    EXPECT_EQ(whole.firstRejected, 3u);
    EXPECT_EQ(whole.rejected, 3u);
}

/// Samples dealt to three strands one by one, with two that are no radiance.
TEST(Statistics, StrandsAddUpToAllSamples) {
    std::vector<glm::dvec3> samples = randomSamples(20, 1, 1);
    samples[11].y = kNaN;
    samples[7].x = -1;
    std::vector<PixelStatistics> strands(3);
    for (size_t i = 0; i < samples.size(); ++i)
        strands[i % 3].add(samples[i]);
    PixelStatistics sum;
    for (uint32_t i = 0; i < 3; ++i)
        sum.mergeStrand(strands[i], i, 3);
    const PixelStatistics all = statisticsOf(samples);
    EXPECT_EQ(sum.count, 18u);
    EXPECT_EQ(sum.rejected, 2u);
    EXPECT_EQ(sum.firstRejected, 7u);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sum.mean[c], all.mean[c], 1e-14);
        EXPECT_NEAR(sum.m2[c], all.m2[c], 1e-13);
    }
}

} // namespace
} // namespace stromboli
