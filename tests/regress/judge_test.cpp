// How pictures of a suite are judged: right ones pass as often as is stated, wrong ones fail.
#include "host/core/error.hpp"
#include "host/regress/judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stromboli::regress {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Exponential samples, brighter by `factor`.
compare::Picture noisy(uint32_t seed, uint32_t samples, double factor = 1) {
    std::mt19937_64 random(seed);
    std::exponential_distribution<> draw;
    Film film(16, 16);
    for (PixelStatistics& p : film.pixels)
        for (uint32_t i = 0; i < samples; ++i)
            p.add({factor * draw(random), factor * draw(random), factor * draw(random)});
    return compare::pictureOf(std::move(film));
}

Outcome judged(const compare::Picture& golden, const compare::Picture& picture,
               const compare::Thresholds& limits = {}, double falseAlarms = 0.01) {
    Outcome outcome;
    outcome.which.limits = limits;
    judge(golden, picture, falseAlarms, outcome);
    return outcome;
}

/// 400 suites of five right pictures, of which 5 % may fail: more than 34 in 400 has the
/// probability 0.002.
TEST(Judging, RightSuitesFailAsSeldomAsIsStated) {
    Suite suite;
    suite.falseAlarms = 0.05;
    suite.pictures.resize(5);
    EXPECT_NEAR(std::pow(1 - falseAlarmsOfEach(suite), 5), 0.95, 1e-12);
    uint32_t failed = 0, seed = 1;
    for (int i = 0; i < 400; ++i) {
        bool passes = true;
        for (int k = 0; k < 5; ++k, seed += 2)
            passes = judged(noisy(seed, 24), noisy(seed + 1, 12), {}, falseAlarmsOfEach(suite))
                             .verdict == Verdict::Agrees &&
                     passes;
        failed += !passes;
    }
    EXPECT_LE(failed, 34u);
}

TEST(Judging, ABrighterPictureDiffers) {
    // The noise of the mean is 1 / sqrt(256 * 16 * 64) = 0.2 %.
    const Outcome o = judged(noisy(1, 256), noisy(2, 64, 1.03));
    EXPECT_EQ(o.verdict, Verdict::Differs);
    ASSERT_FALSE(o.reasons.empty());
    EXPECT_THAT(o.reasons.front(), HasSubstr("the mean is off by +"));
}

TEST(Judging, OneWrongPixelDiffers) {
    compare::Picture picture = noisy(2, 64);
    PixelStatistics& p = picture.film->pixels[17];
    p.mean += 20.0;
    picture.rgb[17] += 20.0;
    EXPECT_EQ(judged(noisy(1, 256), picture).verdict, Verdict::Differs);
}

TEST(Judging, TwoSamplesDecideNothing) {
    EXPECT_EQ(judged(noisy(1, 1), noisy(2, 1)).verdict, Verdict::Undecided);
}

TEST(Judging, LimitsHoldBesideStatisticsAndWithoutThem) {
    const compare::Picture golden = noisy(1, 64), picture = noisy(2, 64);
    EXPECT_EQ(judged(golden, picture, {.relMse = 1}).verdict, Verdict::Agrees);
    EXPECT_EQ(judged(golden, picture, {.relMse = 1e-9}).verdict, Verdict::Differs);
    compare::Picture plain = golden; // as a PNG
    plain.film.reset();
    EXPECT_EQ(judged(plain, picture, {.relMse = 1}).verdict, Verdict::Agrees);
    EXPECT_EQ(judged(plain, picture, {.relMse = 1e-9}).verdict, Verdict::Differs);
    EXPECT_EQ(judged(plain, plain).verdict, Verdict::Agrees);
    EXPECT_EQ(judged(plain, picture).verdict, Verdict::Differs); // nothing else to judge by
    EXPECT_THROW(judged(compare::Picture(4, 4), picture), UsageError);
}

TEST(Judging, BudgetsAreRemarksAndFailNothing) {
    Outcome o = judged(noisy(1, 64), noisy(2, 64));
    o.which.seconds = 2, o.which.megabytes = 100;
    o.seconds = 1.5, o.megabytes = 90;
    noteBudgets(o);
    EXPECT_THAT(o.remarks, IsEmpty());
    o.seconds = 2.5, o.megabytes = 110;
    noteBudgets(o);
    EXPECT_EQ(o.remarks.size(), 2u);
    EXPECT_EQ(o.verdict, Verdict::Agrees);
}

} // namespace
} // namespace stromboli::regress
