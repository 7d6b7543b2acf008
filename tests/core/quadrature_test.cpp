#include "host/core/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

/// Of x^degree over [0, 1].
double integralOfPower(const Quadrature& rule, int degree) {
    double sum = 0;
    for (size_t i = 0; i < rule.at.size(); ++i)
        sum += rule.weight[i] * std::pow(rule.at[i], degree);
    return sum;
}

TEST(Quadrature, GaussAndLegendresRuleIsExactForPolynomials) {
    for (const int count : {1, 2, 5, 12, 32, 64}) {
        const Quadrature rule = gaussLegendre(count);
        ASSERT_EQ(rule.at.size(), size_t(count));
        for (int degree = 0; degree < 2 * count; ++degree)
            EXPECT_NEAR(integralOfPower(rule, degree), 1.0 / (degree + 1), 1e-14)
                << count << " points, degree " << degree;
    }
    EXPECT_GT(std::abs(integralOfPower(gaussLegendre(2), 4) - 0.2), 1e-3) << "and no further";
}

TEST(Quadrature, MidpointsAreThoseOfStretchesOfOneLength) {
    const Quadrature rule = midpoints(4);
    EXPECT_EQ(rule.at, (std::vector<double>{0.875, 0.625, 0.375, 0.125}));
    EXPECT_EQ(rule.weight, std::vector<double>(4, 0.25));
}

} // namespace
} // namespace stromboli
