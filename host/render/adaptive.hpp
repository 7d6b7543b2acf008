#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/budget.hpp"

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

} // namespace stromboli
