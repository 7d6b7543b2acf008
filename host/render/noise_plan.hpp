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

    /// mostSamples: of one pixel; branches: paths of a sample.
    NoisePlan(std::vector<uint32_t> pixels, uint32_t mostSamples, uint32_t branches = 1);

    /// The next pass, of at most `budget` samples. Empty when the picture is there, when every
    /// pixel has mostSamples, or when the budget would change next to nothing. noise: the picture's
    /// target (0: none); no more is planned than seems to be needed for it.
    std::vector<PixelTarget> next(const Film& film, const NoiseEstimate& estimate, uint64_t budget,
                                  double noise) const;

  private:
    std::vector<PixelTarget> raiseAll(const Film& film, uint64_t budget) const;
    std::vector<PixelTarget> spread(const Film& film, const std::vector<double>& relativeVariance,
                                    uint64_t budget) const;

    std::vector<uint32_t> pixels_;
    uint32_t mostSamples_, firstSamples_;
};

} // namespace stromboli
