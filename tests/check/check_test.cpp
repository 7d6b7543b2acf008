// Synthetic films with known distributions: how often the cross-check calls equal films different,
// and what differences it finds.
#include "host/check/cross_check.hpp"
#include "tests/support/test_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

namespace stromboli {
namespace {

using Generator = std::mt19937_64;
/// One sample at a pixel.
using Distribution = std::function<double(uint32_t x, uint32_t y, Generator&)>;

Film makeFilm(uint32_t size, uint32_t samples, const Distribution& draw, Generator& random) {
    Film film(size, size);
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
            for (uint32_t i = 0; i < samples; ++i) {
                const double r = draw(x, y, random), g = draw(x, y, random);
                film.at(x, y).add({r, g, 0.5 * g});
            }
    return film;
}

double uniform(Generator& random) {
    return std::uniform_real_distribution<>()(random);
}

/// Mean 1, deviation 0.2.
double mild(uint32_t, uint32_t, Generator& random) {
    return 1 + 0.2 * std::sqrt(12.0) * (uniform(random) - 0.5);
}
/// Mean and deviation 1.
double exponential(uint32_t, uint32_t, Generator& random) {
    return -std::log1p(-uniform(random));
}
/// Dim, with one sample in a thousand a firefly of a long tail.
double fireflies(uint32_t, uint32_t, Generator& random) {
    if (uniform(random) >= 1e-3) return 0.1 * uniform(random);
    return std::exp(4 + 1.5 * std::normal_distribution<>()(random));
}
/// Infinite variance: density 1.5 / v^2.5 for v > 1.
double pareto(uint32_t, uint32_t, Generator& random) {
    return std::pow(1 - uniform(random), -1 / 1.5);
}
/// Black, constant, and pixels that an emitter of radiance 10 covers in part.
double emitterEdges(uint32_t x, uint32_t y, Generator& random) {
    if (x < 8) return 0;
    if (x < 16) return 10;
    return uniform(random) < (y + 1) / 33.0 ? 10 : 0;
}

struct FalseAlarm {
    const char* name;
    Distribution draw;
    uint32_t samplesA, samplesB;
};
void PrintTo(const FalseAlarm& c, std::ostream* out) {
    *out << c.name << " " << c.samplesA << " against " << c.samplesB;
}

class FalseAlarms : public testing::TestWithParam<FalseAlarm> {};

TEST_P(FalseAlarms, AreAsRareAsStated) {
    constexpr int kTrials = 200;
    CheckSettings settings;
    settings.familyError = 0.05;
    Generator random(GetParam().samplesA * 1000 + GetParam().samplesB);
    int alarms = 0;
    for (int i = 0; i < kTrials; ++i) {
        const Film a = makeFilm(32, GetParam().samplesA, GetParam().draw, random);
        const Film b = makeFilm(32, GetParam().samplesB, GetParam().draw, random);
        alarms += crossCheck(a, b, settings).anyDiffers() ? 1 : 0;
    }
    // Binomial: 10 expected with deviation 3.1; 4.5 of those on top.
    EXPECT_LE(alarms, 24);
    RecordProperty("alarms", alarms);
}

INSTANTIATE_TEST_SUITE_P(Distributions, FalseAlarms,
                         testing::Values(FalseAlarm{"mild", mild, 8, 8},
                                         FalseAlarm{"exponential", exponential, 2, 2},
                                         FalseAlarm{"exponential", exponential, 1, 1},
                                         FalseAlarm{"exponential", exponential, 4, 16},
                                         FalseAlarm{"fireflies", fireflies, 4, 4},
                                         FalseAlarm{"fireflies", fireflies, 16, 16},
                                         FalseAlarm{"fireflies", fireflies, 4, 16},
                                         FalseAlarm{"pareto", pareto, 8, 8},
                                         FalseAlarm{"pareto", pareto, 4, 16},
                                         FalseAlarm{"emitter edges", emitterEdges, 4, 4},
                                         FalseAlarm{"emitter edges", emitterEdges, 16, 16},
                                         FalseAlarm{"emitter edges", emitterEdges, 4, 16}),
                         test::NamedByValue{});

/// Films of 64 x 64 pixels of 64 samples with deviation 0.2 of the mean: in a region of 32 x 32 the
/// difference of the means has deviation 0.2 sqrt(2 / (64 * 1024)) = 0.11 %.
TEST(Power, OnePercentInOneRegionIsFound) {
    Generator random(1);
    const Film a = makeFilm(64, 64, mild, random);
    const Film b = makeFilm(
        64, 64,
        [](uint32_t x, uint32_t y, Generator& r) {
            const bool biased = x >= 24 && x < 56 && y >= 16 && y < 48;
            return mild(x, y, r) * (biased ? 1.01 : 1);
        },
        random);
    const CheckResult result = crossCheck(a, b);
    EXPECT_FALSE(result.agree());
    EXPECT_FALSE(result.blocksAgree);
    EXPECT_LT(result.worstBlock.z, -result.blockLimit);
    EXPECT_GE(result.worstBlock.x, 16u); // inside the region, or around it
    EXPECT_TRUE(crossCheck(a, makeFilm(64, 64, mild, random)).agree());
}

/// (limit + 1.645) standard errors, and what rounding may explain.
TEST(Sight, FollowsFromTheStandardError) {
    Generator random(8);
    const CheckResult r =
        crossCheck(makeFilm(64, 64, mild, random), makeFilm(64, 64, mild, random));
    const double expected =
        (r.channelLimit + 1.6448536) * 0.2 * std::sqrt(2.0 / (64 * 64 * 64)) + 0x1p-16;
    // The variance of a pixel's samples is known to some 15 %, of all of them to 0.2 %.
    for (const CheckChannel& channel : r.channels)
        EXPECT_NEAR(channel.visible, expected, 0.01 * expected);
    EXPECT_EQ(r.verdict(), Verdict::Agree);
    EXPECT_THAT(formatCheck(r), testing::HasSubstr("sight      differences of the means found"));
}

TEST(Sight, DifferencesOfThatSizeAreFoundAsOftenAsStated) {
    constexpr int kTrials = 400;
    Generator random(9);
    int found = 0;
    for (int i = 0; i < kTrials; ++i) {
        const double seen = crossCheck(makeFilm(16, 4, mild, random), makeFilm(16, 4, mild, random))
                                .channels[0]
                                .visible;
        const double factor = (1 + seen / 2) / (1 - seen / 2);
        const Film brighter = makeFilm(
            16, 4, [&](uint32_t x, uint32_t y, Generator& r) { return factor * mild(x, y, r); },
            random);
        const CheckResult r = crossCheck(brighter, makeFilm(16, 4, mild, random));
        found += r.channels[0].z > r.channelLimit ? 1 : 0;
    }
    // Binomial: 380 expected with deviation 4.4; 4.5 of those either way.
    EXPECT_GE(found, 360);
    EXPECT_LT(found, kTrials);
}

/// Four pixels whose samples have the deviation 1 of their mean: a standard error of 50 %.
TEST(Sight, NoiseThatWouldHideABlackPictureDecidesNothing) {
    Generator random(10);
    const CheckResult r =
        crossCheck(makeFilm(2, 2, exponential, random), makeFilm(2, 2, exponential, random));
    EXPECT_EQ(r.verdict(), Verdict::Undecided);
    EXPECT_FALSE(r.agree());
    EXPECT_THAT(formatCheck(r), testing::AllOf(testing::HasSubstr("from nothing (red)"),
                                               testing::HasSubstr("UNDECIDED: the noise")));
}

TEST(Sight, OneSampleDecidesNothingButMayDiffer) {
    Generator random(11);
    const auto dark = [](uint32_t x, uint32_t y, Generator& r) { return 0.5 * mild(x, y, r); };
    const Film one = makeFilm(32, 1, mild, random);
    const CheckResult same = crossCheck(one, makeFilm(32, 1, mild, random));
    EXPECT_EQ(same.verdict(), Verdict::Undecided);
    EXPECT_THAT(formatCheck(same), testing::HasSubstr("UNDECIDED: no pixel has two samples"));
    EXPECT_EQ(crossCheck(one, makeFilm(32, 1, dark, random)).verdict(), Verdict::Different);
    EXPECT_EQ(crossCheck(one, makeFilm(32, 8, mild, random)).verdict(), Verdict::Agree);
}

TEST(Sight, BlackPicturesAgree) {
    Film a(16, 16), b(16, 16);
    for (Film* film : {&a, &b})
        for (PixelStatistics& p : film->pixels)
            for (int i = 0; i < 4; ++i)
                p.add(glm::dvec3(0));
    EXPECT_EQ(crossCheck(a, b).verdict(), Verdict::Agree);
    EXPECT_THAT(formatCheck(crossCheck(a, b)), testing::HasSubstr("from black (red)"));
}

TEST(Check, WhatIsNotANumberAgreesWithNothing) {
    Generator random(12);
    const Film a = makeFilm(16, 8, mild, random);
    Film b = makeFilm(16, 8, mild, random);
    b.at(3, 4).m2.y = std::nan("");
    EXPECT_FALSE(crossCheck(a, b).channelsAgree);
    EXPECT_FALSE(crossCheck(a, b).blocksAgree);
    b = makeFilm(16, 8, mild, random);
    b.at(3, 4).mean.y = std::nan("");
    EXPECT_EQ(crossCheck(a, b).verdict(), Verdict::Different);
}

TEST(Power, OneDarkBlockIsFoundAndNamed) {
    Generator random(2);
    const Film a = makeFilm(64, 16, exponential, random);
    const Film b = makeFilm(
        64, 16,
        [](uint32_t x, uint32_t y, Generator& r) {
            return exponential(x, y, r) * (x / 8 == 3 && y / 8 == 5 ? 0.7 : 1);
        },
        random);
    const CheckResult result = crossCheck(a, b);
    EXPECT_FALSE(result.blocksAgree);
    EXPECT_TRUE(result.channelsAgree);
    EXPECT_EQ(result.worstBlock.x, 24u);
    EXPECT_EQ(result.worstBlock.y, 40u);
    EXPECT_EQ(result.worstBlock.width, 8u);
    EXPECT_GT(result.worstBlock.z, 0);
}

TEST(Power, SmallBiasOfTheWholePictureIsFound) {
    Generator random(3);
    const Film a = makeFilm(64, 64, exponential, random);
    const Film b = makeFilm(
        64, 64, [](uint32_t x, uint32_t y, Generator& r) { return 1.02 * exponential(x, y, r); },
        random);
    const CheckResult result = crossCheck(a, b);
    EXPECT_FALSE(result.channelsAgree);
    EXPECT_NEAR(result.channels[1].relativeDifference, -0.02, 0.012);
    EXPECT_NEAR(result.channels[2].meanB, 0.51, 0.01);
}

TEST(Power, WrongPixelsWhoseErrorsCancelAreFound) {
    Generator random(4);
    const Film a = makeFilm(64, 64, mild, random);
    const Film b = makeFilm(
        64, 64,
        [](uint32_t x, uint32_t y, Generator& r) {
            return mild(x, y, r) + ((x + y) % 2 == 0 ? 0.3 : -0.3);
        },
        random);
    const CheckResult result = crossCheck(a, b);
    EXPECT_FALSE(result.pixelsAgree);
    EXPECT_LT(result.fractionPassing, 0.5);
    EXPECT_TRUE(result.channelsAgree);
}

TEST(Constants, MustBeEqualUpToRounding) {
    Film a(32, 32), b(32, 32);
    for (size_t i = 0; i < a.pixels.size(); ++i)
        for (int s = 0; s < 32; ++s) {
            a.pixels[i].add({1, 0.1, 0});
            b.pixels[i].add({1 + 1e-6, 0.1f, 0});
        }
    EXPECT_TRUE(crossCheck(a, b).agree());

    b.at(5, 6) = {};
    for (int s = 0; s < 32; ++s)
        b.at(5, 6).add({1, 0.1001, 0});
    const CheckResult result = crossCheck(a, b);
    EXPECT_EQ(result.constantMismatches, 1u);
    EXPECT_FALSE(result.constantsAgree);
    EXPECT_EQ(result.worstPixel.x, 5u);
    EXPECT_EQ(result.worstPixel.y, 6u);
    EXPECT_TRUE(result.pixelsAgree) << "one of 1024 is below the 0.25 % that may fail";
}

/// A device cannot tell samples of 1e-20 that differ from equal ones: their squares are no floats.
TEST(Constants, AreUnknownWhereSquaresUnderflow) {
    for (const auto& [value, mismatches] : {std::pair(1e-20, 0u), std::pair(1e-12, 1u)}) {
        Film a(8, 8), b(8, 8);
        for (int s = 0; s < 64; ++s)
            a.at(2, 3).add(glm::dvec3(value)), b.at(2, 3).add(glm::dvec3(0));
        EXPECT_EQ(crossCheck(a, b).constantMismatches, mismatches) << value;
    }
}

TEST(Check, SkipsPixelsWithoutSamples) {
    Generator random(6);
    Film a = makeFilm(20, 4, mild, random), b = makeFilm(20, 4, mild, random);
    a.at(3, 3) = {};
    EXPECT_EQ(crossCheck(a, b).pixels, 399u);
    const CheckResult nothing = crossCheck(Film(4, 4), Film(4, 4));
    EXPECT_FALSE(nothing.agree());
    EXPECT_THAT(formatCheck(nothing), testing::HasSubstr("no pixel"));
    EXPECT_THROW(crossCheck(a, Film(20, 21)), std::invalid_argument);
}

TEST(Check, ReportNamesTheVerdictAndTheWorstBlock) {
    Generator random(7);
    const Film a = makeFilm(32, 16, mild, random);
    EXPECT_THAT(formatCheck(crossCheck(a, makeFilm(32, 16, mild, random))),
                testing::EndsWith("verdict: the pictures agree\n"));
    Film b = makeFilm(32, 16, mild, random);
    for (uint32_t y = 8; y < 16; ++y)
        for (uint32_t x = 16; x < 24; ++x)
            b.at(x, y).mean *= 1.5;
    b.at(0, 0).add(glm::dvec3(-1));
    const std::string report = formatCheck(crossCheck(a, b));
    EXPECT_THAT(report, testing::HasSubstr("at (16, 8), 8 x 8"));
    EXPECT_THAT(report, testing::HasSubstr("samples rejected: 0 and 1"));
    EXPECT_THAT(report, testing::EndsWith("verdict: DIFFERENT\n"));
}

double differenceOf(std::initializer_list<double> a, int timesA, std::initializer_list<double> b) {
    PixelStatistics pa, pb;
    for (int i = 0; i < timesA; ++i)
        for (double v : a)
            pa.add(glm::dvec3(v));
    for (double v : b)
        pb.add(glm::dvec3(v));
    Difference difference;
    difference.add(pa, pb, 1);
    return difference.z(0);
}

TEST(PixelDifference, FewSamplesProveLittle) {
    EXPECT_NEAR(differenceOf({10}, 4, {0, 0, 0, 0}), std::sqrt(7.0), 1e-12);
    EXPECT_NEAR(differenceOf({1}, 1, {2}), -1, 1e-12);
}

TEST(PixelDifference, OneBrightSampleOfTheLargerSetIsNoSurprise) {
    // All 20 samples: sum 16, squared deviations 243.2, variance 12.8; times 1/4 + 1/16 is 4.
    EXPECT_NEAR(differenceOf({0}, 4, {16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), -0.5,
                1e-12);
}

TEST(PixelDifference, ANoisyFewAgainstACalmMany) {
    // Variances of the means: 0 and 4/3; 68 samples.
    EXPECT_NEAR(differenceOf({1}, 64, {0, 0, 4, 4}), -1 / std::sqrt(4.0 / 3 * 66 / 67 + 1.0 / 67),
                1e-12);
}

TEST(Normal, QuantilesAndSidakLevels) {
    EXPECT_NEAR(twoSidedQuantile(0.05), 1.959964, 1e-6);
    EXPECT_NEAR(twoSidedQuantile(twoSidedProbability(7.5)), 7.5, 1e-9);
    EXPECT_NEAR(sidakLevel(0.05, 1), 0.05, 1e-15);
    EXPECT_NEAR(1 - std::pow(1 - sidakLevel(0.05, 1000), 1000), 0.05, 1e-12);
}

TEST(CrossCheck, WhatFloatsCannotHoldIsBlack) {
    Film black(8, 8), faint(8, 8);
    for (PixelStatistics& p : black.pixels)
        p.count = 64;
    for (PixelStatistics& p : faint.pixels)
        p.count = 64, p.mean = glm::dvec3(1e-40);
    EXPECT_TRUE(crossCheck(black, faint).agree());
    for (PixelStatistics& p : faint.pixels)
        p.mean = glm::dvec3(1e-20);
    EXPECT_FALSE(crossCheck(black, faint).agree());
}

} // namespace
} // namespace stromboli
