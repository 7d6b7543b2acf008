#include "host/study/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::study {
namespace {

TEST(StudyEstimate, QuantilesOfStudentsDistribution) {
    // Closed forms: tan(0.475 pi) for one degree of freedom; for two, t = q sqrt(2 / (1 - q^2))
    // with q = 0.95. The normal quantile for many.
    EXPECT_NEAR(tQuantile(1), std::tan(0.475 * M_PI), 1e-6);
    EXPECT_NEAR(tQuantile(2), 0.95 * std::sqrt(2 / (1 - 0.95 * 0.95)), 1e-6);
    EXPECT_NEAR(tQuantile(1e6), 1.959964, 1e-4);
}

TEST(StudyEstimate, MeanAndIntervalByHand) {
    const double values[] = {1, 2, 6}; // mean 3, standard error sqrt(7 / 3)
    const double half = tQuantile(2) * std::sqrt(7.0 / 3);
    const Estimate e = meanOf(values);
    EXPECT_DOUBLE_EQ(e.value, 3);
    EXPECT_NEAR(e.interval->first, 3 - half, 1e-12);
    EXPECT_NEAR(e.interval->second, 3 + half, 1e-12);
    const Estimate p = positiveMeanOf(values);
    EXPECT_NEAR(p.interval->first, 3 * std::exp(-half / 3), 1e-12);
    EXPECT_NEAR(p.interval->second, 3 * std::exp(half / 3), 1e-12);
    EXPECT_FALSE(meanOf(std::vector<double>{5}).interval);
}

TEST(StudyEstimate, RatioByWelch) {
    const double a[] = {1, 3}, b[] = {0, 1, 2}; // means 2 and 1, variances 2 and 1
    const double va = 1, vb = 1.0 / 3, v = va + vb;
    const double degrees = v * v / (va * va / 1 + vb * vb / 2);
    const Estimate e = ratioOf(a, b);
    EXPECT_NEAR(e.value, std::exp(1), 1e-12);
    EXPECT_NEAR(e.interval->second, std::exp(1 + tQuantile(degrees) * std::sqrt(v)), 1e-9);
    EXPECT_FALSE(ratioOf(a, std::vector<double>{1}).interval);
}

TEST(StudyEstimate, PowerLawsAreReadExactly) {
    Curve curve;
    for (const double x : {1.0, 3.0, 10.0, 50.0})
        curve.emplace_back(x, 7 * std::pow(x, -1.5));
    EXPECT_NEAR(*logSlope(curve), -1.5, 1e-12);
    for (const double x : {0.1, 1.0, 5.0, 50.0, 400.0}) {
        const double y = 7 * std::pow(x, -1.5);
        EXPECT_NEAR(yAt(curve, x)->value, y, 1e-12 * y);
        EXPECT_NEAR(xAt(curve, y)->value, x, 1e-9 * x);
        EXPECT_EQ(yAt(curve, x)->extrapolated, x < 1 || x > 50);
    }
    EXPECT_TRUE(xAt(curve, 1e-9)->extrapolated);
    EXPECT_FALSE(xAt(curve, 0.1)->extrapolated);
}

TEST(StudyEstimate, BetweenPointsOnStraightLinesOfTheLogarithms) {
    const Curve bent = {{1, 100}, {10, 10}, {100, 8}};
    EXPECT_NEAR(yAt(bent, std::sqrt(10.0))->value, std::sqrt(1000.0), 1e-9);
    EXPECT_NEAR(xAt(bent, std::sqrt(80.0))->value, std::sqrt(1000.0), 1e-9);
}

TEST(StudyEstimate, WhatCannotBeReadIsNone) {
    EXPECT_FALSE(yAt({{1, 1}}, 2));
    EXPECT_FALSE(xAt({}, 2));
    EXPECT_FALSE(xAt({{1, 1}, {2, 4}}, 0.5)); // the error grows
    EXPECT_FALSE(logSlope({{2, 1}, {2, 3}}));
}

TEST(StudyEstimate, Median) {
    EXPECT_EQ(medianOf({5, 1, 3}), 3);
    EXPECT_EQ(medianOf({5, 1, 3, 4}), 3.5);
    EXPECT_EQ(medianOf({}), 0);
}

} // namespace
} // namespace stromboli::study
