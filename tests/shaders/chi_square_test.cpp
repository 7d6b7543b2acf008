// The test's test: quantiles from Abramowitz and Stegun, table 26.8.
#include "tests/support/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

TEST(ChiSquare, Quantiles) {
    EXPECT_NEAR(chiSquareTail(3.84146, 1), 0.05, 1e-6);
    EXPECT_NEAR(chiSquareTail(23.2093, 10), 0.01, 1e-6);
    EXPECT_NEAR(chiSquareTail(4.86518, 10), 0.90, 1e-6);
    EXPECT_NEAR(chiSquareTail(149.449, 100), 0.001, 1e-6);
    EXPECT_NEAR(chiSquareTail(1000, 1000), 0.49404, 1e-4);
    EXPECT_EQ(chiSquareTail(0, 5), 1);
}

TEST(ChiSquare, PoolsSmallBinsAndKnowsImpossibleOnes) {
    EXPECT_GT(chiSquareTest({100, 104, 1, 2, 3}, {102, 102, 2, 2, 2}), 0.9);
    EXPECT_LT(chiSquareTest({150, 54, 1, 2, 3}, {102, 102, 2, 2, 2}), 1e-6);
    EXPECT_EQ(chiSquareTest({100, 1}, {101, 0}), 0);
    EXPECT_NEAR(1 - std::pow(1 - sidakLevel(0.01, 20), 20), 0.01, 1e-12);
}

} // namespace
} // namespace stromboli::test
