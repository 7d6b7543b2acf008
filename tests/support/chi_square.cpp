#include "tests/support/chi_square.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace stromboli::test {
namespace {

/// Regularised lower incomplete gamma function by its power series (Abramowitz and Stegun 6.5.29);
/// converges fast for x < a + 1.
double lowerGamma(double a, double x) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * std::numeric_limits<double>::epsilon(); ++n)
        sum += term *= x / n;
    return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// The upper one by its continued fraction (6.5.31), evaluated from the tail; for x >= a + 1 the
/// depth suffices by far for the degrees of freedom of tests.
double upperGamma(double a, double x) {
    double fraction = 0;
    for (int n = 2000; n > 0; --n)
        fraction = n * (n - a) / (x + 2 * n + 1 - a - fraction);
    return std::exp(a * std::log(x) - x - std::lgamma(a)) / (x + 1 - a - fraction);
}

} // namespace

double chiSquareTail(double x, double degrees) {
    const double a = degrees / 2, half = x / 2;
    if (!(half > 0)) return 1;
    return half < a + 1 ? 1 - lowerGamma(a, half) : upperGamma(a, half);
}

double chiSquareTest(const std::vector<double>& counts, const std::vector<double>& expected) {
    constexpr double kLeastExpected = 5;
    double statistic = 0, pooledCount = 0, pooledExpected = 0;
    size_t bins = 0;
    for (size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] == 0 && counts[i] > 0) return 0;
        if (expected[i] < kLeastExpected) {
            pooledCount += counts[i];
            pooledExpected += expected[i];
            continue;
        }
        statistic += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
        ++bins;
    }
    if (pooledExpected > 0) {
        statistic +=
            (pooledCount - pooledExpected) * (pooledCount - pooledExpected) / pooledExpected;
        ++bins;
    }
    return chiSquareTail(statistic, double(bins) - 1);
}

double sidakLevel(double alpha, size_t tests) {
    return -std::expm1(std::log1p(-alpha) / double(tests));
}

} // namespace stromboli::test
