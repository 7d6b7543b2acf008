#include "host/check/difference.hpp"

#include <algorithm>
#include <cmath>

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
}

void Difference::add(const Difference& other) {
    sumA_ += other.sumA_;
    sumB_ += other.sumB_;
    separate_ += other.separate_;
    pooled_ += other.pooled_;
}

double Difference::z(double rounding) const {
    const double d = sumA_ - sumB_;
    // Radiance is not negative, so the sums bound the sum of the pixels' own rounding errors.
    const double excess = std::abs(d) - rounding * std::max(sumA_, sumB_) - kUnderflow;
    if (!(excess > 0)) return 0;
    return std::copysign(excess / std::sqrt(std::max(separate_, pooled_)), d);
}

} // namespace stromboli
