#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace stromboli::study {

/// A value with its 95 % confidence interval, if more than one measurement gives one.
struct Estimate {
    double value = 0;
    std::optional<std::pair<double, double>> interval;
};

/// 97.5 % quantile of Student's t distribution; degrees of freedom >= 1.
double tQuantile(double degreesOfFreedom);

/// Mean and its t interval.
Estimate meanOf(std::span<const double> values);

/// Mean of positive values, with a t interval on the logarithmic axis, to first order: relative
/// standard error times t, as a factor. Never reaches 0.
Estimate positiveMeanOf(std::span<const double> values);

/// exp of the difference of the means of two sets of logarithms, by Welch's test (1947). Intervals
/// need two values in each.
Estimate ratioOf(std::span<const double> logA, std::span<const double> logB);

double medianOf(std::vector<double> values);

/// Points (x, y) of a curve on log-log axes, x growing, both positive.
using Curve = std::vector<std::pair<double, double>>;

/// Slope of the line of least squares through the logarithms; none for fewer than two points.
std::optional<double> logSlope(const Curve& curve);

struct Reading {
    double value = 0;
    bool extrapolated = false; ///< beyond the curve's ends, along its line of least squares
};

/// y at x, and the first x at which the curve comes down to y, between points on the straight line
/// of the log-log axes. None for fewer than two points, or if the curve does not fall.
std::optional<Reading> yAt(const Curve& curve, double x);
std::optional<Reading> xAt(const Curve& curve, double y);

} // namespace stromboli::study
