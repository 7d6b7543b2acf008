#include "host/check/difference.hpp"

#include "host/check/normal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli {

void Difference::add(const PixelStatistics& a, const PixelStatistics& b, int channel) {
    const double na = a.count, nb = b.count, n = na + nb;
    const double d = a.mean[channel] - b.mean[channel];
    sumA_ += a.mean[channel];
    sumB_ += b.mean[channel];
    const double own = a.varianceOfMean()[channel] + b.varianceOfMean()[channel];
    // E d^2 is the variance itself: both estimates are unbiased. For na = nb they are equal.
    separate_ += own * ((n - 2) / (n - 1)) + d * d / (n - 1);
    const double deviations = a.m2[channel] + b.m2[channel] + d * d * na * nb / n;
    pooled_ += deviations / (n - 1) * (n / (na * nb));
    const double both = 0.5 * (a.mean[channel] + b.mean[channel]);
    ownShare_ += both * both / (n - 1);
}

void Difference::add(const Difference& other) {
    sumA_ += other.sumA_;
    sumB_ += other.sumB_;
    separate_ += other.separate_;
    pooled_ += other.pooled_;
    ownShare_ += other.ownShare_;
}

double Difference::z(double rounding) const {
    const double d = sumA_ - sumB_;
    // Radiance is not negative, so the sums bound the sum of the pixels' own rounding errors.
    const double excess = std::abs(d) - rounding * std::max(sumA_, sumB_) - kUnderflow;
    if (excess <= 0) return 0;
    const double deviations = excess / std::sqrt(variance());
    // What is not a number agrees with nothing.
    return std::isnan(deviations) ? std::numeric_limits<double>::infinity()
                                  : std::copysign(deviations, d);
}

/// A relative difference x shifts the difference of the sums by x m, m the mean of both sums, and
/// makes its estimated variance v + x^2 q, q = ownShare_. It is found with probability `power`
/// where x m - p sqrt(v) - r = limit sqrt(v + x^2 q): p is the normal quantile of `power`, r what
/// rounding may explain. With c = p sqrt(v) + r this is a quadratic equation, of which the root
/// with x m > c is returned; there is none unless m > limit sqrt(q).
double Difference::visible(double limit, double power, double rounding) const {
    constexpr double kNothing = std::numeric_limits<double>::infinity();
    if (isBlack()) return kNothing;
    const double m = 0.5 * (sumA_ + sumB_), v = variance(), q = ownShare_;
    const double a = m * m - limit * limit * q;
    if (!(a > 0)) return kNothing;
    const double c = twoSidedQuantile(2 * (1 - power)) * std::sqrt(v) + rounding * m + kUnderflow;
    return (m * c + limit * std::sqrt(a * v + q * c * c)) / a;
}

} // namespace stromboli
