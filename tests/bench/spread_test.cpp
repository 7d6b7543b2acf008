#include "host/bench/measuring.hpp"

#include <gtest/gtest.h>

namespace stromboli::bench {
namespace {

TEST(Spread, OddNumberOfValues) {
    const Spread s = spreadOf({5, 1, 4, 2, 3});
    EXPECT_EQ(s.median, 3);
    EXPECT_EQ(s.least, 1);
    EXPECT_EQ(s.most, 5);
    EXPECT_EQ(s.lowerQuartile, 2);
    EXPECT_EQ(s.upperQuartile, 4);
}

TEST(Spread, EvenNumberOfValuesInterpolates) {
    const Spread s = spreadOf({4, 1, 3, 2});
    EXPECT_EQ(s.median, 2.5);
    EXPECT_EQ(s.lowerQuartile, 1.75); // three quarters of the way from 1 to 2
    EXPECT_EQ(s.upperQuartile, 3.25);
}

TEST(Spread, OneOutlierMovesTheMeanButNotTheMedian) {
    EXPECT_EQ(spreadOf({1, 1, 1, 1, 1000}).median, 1);
}

TEST(Spread, OneValueAndNone) {
    const Spread one = spreadOf({7});
    EXPECT_EQ(one.median, 7);
    EXPECT_EQ(one.lowerQuartile, 7);
    EXPECT_EQ(one.most, 7);
    EXPECT_EQ(spreadOf({}).median, 0);
}

} // namespace
} // namespace stromboli::bench
