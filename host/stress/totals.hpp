#pragma once

#include "host/film/film.hpp"

namespace stromboli::stress {

/// All samples of a picture together.
struct Totals {
    explicit Totals(const Film& film);
    explicit Totals(const PixelStatistics& samples) : all(samples) {}

    /// Sum of the samples' values, of the channel that has most.
    double sum() const;
    /// Standard error of the mean.
    glm::dvec3 error() const { return glm::sqrt(all.varianceOfMean()); }

    PixelStatistics all;
};

/// All samples of a picture's column, counted from the left.
PixelStatistics columnOf(const Film& film, uint32_t x);

/// Relative error that the kernel's arithmetic may put on a mean: a sample is a product and sum of
/// some hundred float operations, each good to 2^-24 to 2^-22, over paths of up to 100 bounces.
inline constexpr double kRounding = 0x1p-14;

/// How far a mean is from what it should be, in standard errors of both, in the worst channel.
/// kRounding of the expected value is free; beyond it, a mean without error is infinitely far off.
double sigmasOff(const Totals& found, const glm::dvec3& expected);
double sigmasOff(const Totals& found, const Totals& other);

} // namespace stromboli::stress
