#pragma once

#include <cstddef>
#include <vector>

namespace stromboli::test {

/// Probability that a chi-square variable with this many degrees of freedom is at least x.
double chiSquareTail(double x, double degrees);

/// Pearson's test of counts against expected counts: the probability of a deviation at least as
/// large if the expectation is right. Bins that expect fewer than 5 are pooled; a count in a bin
/// that expects none gives 0.
double chiSquareTest(const std::vector<double>& counts, const std::vector<double>& expected);

/// The level of one of `tests` tests such that all of them together err with probability alpha
/// (Sidak 1967).
double sidakLevel(double alpha, size_t tests);

} // namespace stromboli::test
