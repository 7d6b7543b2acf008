#pragma once

#include "host/film/film.hpp"

#include <algorithm>

namespace stromboli {

/// Radiance that float arithmetic may turn into 0: a factor below 2^-126 vanishes, and may have
/// been about to be multiplied by up to 2^26 (radiance, areas, densities).
inline constexpr double kUnderflow = 0x1p-100;

/// Sum over pixels of the difference of two films' means in one channel, with its variance.
///
/// The variance is the one that holds if the films agree. Two estimates of it are kept and the
/// larger one is used:
/// - separate: each film's own variance. Right whatever the two sample counts and whether or not
///   single samples of both films have the same distribution.
/// - pooled: both films' samples as one set, as in a permutation test. Right for rare bright
/// samples
///   that one film happens to have and the other has not, where the separate one is too small.
/// Either contains the difference itself, so that a pixel of n samples in each film never has
/// |z| > sqrt(2 n - 1): few samples prove little, however equal they are.
class Difference {
  public:
    /// Both pixels have at least one sample.
    void add(const PixelStatistics& a, const PixelStatistics& b, int channel);
    void add(const Difference& other);

    double sumA() const { return sumA_; }
    double sumB() const { return sumB_; }
    /// Difference of the sums, A - B, moved towards 0 by what rounding to float may explain, in
    /// standard deviations. `rounding`: relative error of each film's values.
    double z(double rounding) const;
    /// How much brighter or darker one film has to be throughout, relative to the mean of both, for
    /// |z| to exceed `limit` with probability `power` (> 1/2), as far as the variance found here is
    /// the true one. Infinite where no difference would do: black pictures, and too few samples.
    double visible(double limit, double power, double rounding) const;
    /// Neither film has radiance that a float could hold.
    bool isBlack() const { return std::max(sumA_, sumB_) <= kUnderflow; }

  private:
    double variance() const { return std::max(separate_, pooled_); }

    double sumA_ = 0, sumB_ = 0, separate_ = 0, pooled_ = 0;
    /// What a relative difference of 1 in every pixel adds to either variance: each contains the
    /// pixel's squared difference / (n - 1).
    double ownShare_ = 0;
};

} // namespace stromboli
