#pragma once

#include "host/render/backend.hpp"
#include "host/render/noise_estimate.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

/// Spreads samples so that the picture's relMSE falls fastest: after a first uniform pass, each
/// pass goes to the pixels whose error falls most per sample. The least relMSE for a number of
/// samples has n proportional to the square root of a pixel's relative variance (Lagrange); growing
/// n where variance / n^2 is largest leads there.
///
/// Counts go up the ladder 4, 6, 8, 12, 16, 24, 32, ..., powers of two and halves between: Sobol
/// points are best at the former, and where all pixels are alike a pass that reaches but some of
/// them costs 4 % at most (half at n, half at 1.5 n, against all at 1.25 n).
class NoisePlan {
  public:
    /// Paths of the uniform pass; a pixel has at least four samples then, whose variances mean
    /// something over its neighbours.
    static constexpr uint32_t kFirstPaths = 8;
    static constexpr uint32_t kLeastFirstSamples = 4;

    /// A pixel has at least this share of the mean number of samples: what is not
    /// known yet cannot show in a variance.
    static constexpr double kLeastShare = 0.125;

    /// Whether the first samples go to all pixels at once, or, where time may be up before that, to
    /// a coarse grid of them first, then to finer ones.
    enum class Beginning { AllAlike, CoarseToFine };

    /// Distance, in pixels, of those that are sampled first. A power of two.
    static constexpr uint32_t kCoarsest = 8;

    /// What planning a pass takes, at most.
    static const uint64_t kBytesPerPixel;

    /// mostSamples: of one pixel; branches: paths of a sample.
    explicit NoisePlan(uint32_t mostSamples, uint32_t branches = 1,
                       Beginning beginning = Beginning::AllAlike);

    /// The next pass, of at most `budget` samples. Empty when the picture's noise is known and, at
    /// the upper end of its range, at most `noise` (0: none is asked for), when every pixel has
    /// mostSamples, or when the budget would change next to nothing. No more is planned than seems
    /// to be needed for that noise.
    std::vector<PixelTarget> next(const Film& film, const NoiseEstimate& estimate, uint64_t budget,
                                  double noise) const;

  private:
    std::vector<PixelTarget> cover(const Film& film) const;
    std::vector<PixelTarget> raiseAll(const Film& film, uint64_t budget) const;
    std::vector<PixelTarget> spread(const Film& film, const std::vector<double>& relativeVariance,
                                    uint64_t budget) const;

    uint32_t mostSamples_, firstSamples_;
    Beginning beginning_;
};

} // namespace stromboli
