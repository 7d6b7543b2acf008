#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/picture_noise.hpp"
#include "host/render/settings.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

/// Decides, pass by pass, which pixels get more samples.
///
/// Uniform: every pixel gets mostSamplesPerPixel, in passes that each quadruple the samples, so
/// that a render that is stopped has a whole picture; the last pass about doubles them, where there
/// are kFirstPass or more.
///
/// Adaptive, default rule: a pixel is finished when 1.96 sigma of its mean luminance is within
/// tolerance times that luminance. Against the published rule's failures: sigma is the larger of
/// the pixel's own and its 3 x 3 neighbourhood's (a pixel that has not met the light yet is not
/// finished while its neighbours have), every pixel has at least kMinimumSamples, the
/// luminance is at least kFloor of the picture's mean (black pixels do finish), and neighbours of
/// unfinished pixels go on, so that a finished pixel is taken up again.
///
/// Adaptive, rule per channel: the published one, at every multiple of the batch.
class SamplingPlan {
  public:
    /// Samples before the first test: a variance from fewer is itself off by a third (chi-square,
    /// normal samples: relative sigma sqrt(2 / 63) = 18 %).
    static constexpr uint32_t kMinimumSamples = 64;
    /// Fraction of the picture's mean luminance below which relative error is not asked for. In a
    /// picture whose mean is mid grey (0.18), a tolerance of 0.05 at this level (0.009) is 0.8 of a
    /// step of 8-bit sRGB.
    static constexpr double kFloor = 0.05;

    static constexpr uint32_t kFirstPass = 16; ///< samples, uniform

    explicit SamplingPlan(const Budget& budget) : budget_(budget) {}
    /// The next pass, in the order of the pixels; empty when all are done.
    std::vector<PixelTarget> next(const Film& film) const;

  private:
    std::vector<PixelTarget> uniform(const Film& film) const;
    std::vector<PixelTarget> adaptive(const Film& film) const;
    std::vector<bool> unfinishedPerChannel(const Film& film) const;
    std::vector<bool> unfinishedByNeighbourhood(const Film& film) const;
    std::vector<bool> dilate(const std::vector<bool>& noisy, const Film& film) const;
    double pictureMean(const Film& film) const;

    Budget budget_;
};

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

    /// Samples are spread where even ones would have so many times their error by what is known
    /// of the noise. Less is lost again: variances of few samples are noise themselves, numbers
    /// that are no powers of two suit Sobol points less, and paths where there is more noise are
    /// longer (docs/results.md, "When samples are spread").
    static constexpr double kLeastGain = 2;

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
