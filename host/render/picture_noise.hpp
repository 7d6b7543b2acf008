#pragma once

#include "host/render/pixel_windows.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// Share of the picture's mean radiance m that is added, squared, to the squared value an error is
/// compared with, so that black pixels do not divide by zero: relMSE with epsilon = 0.01 m^2, as
/// `stromboli compare` computes it.
constexpr double kRelativeFloor = 0.1;

/// So few pixels of a picture that nobody would want its noise to rest on them.
constexpr size_t kWorstPixels = 10;

/// What a picture's own samples say of its noise, the square root of its relMSE: 0.02 is 2 %.
struct PictureNoise {
    enum class Unknown {
        No,            ///< the figures below mean something
        TooFewSamples, ///< a pixel has fewer than two samples
        Black,         ///< no sample has met light
        TooFewPixels,  ///< nearly all of the noise is that of one or two pixels
    };
    Unknown unknown = Unknown::TooFewSamples;
    double estimate = 0;
    /// A range that holds the noise in 95 of 100 renders (docs/theory/noise.md, "How noisy a
    /// picture is"; docs/results.md has the test of it).
    double least = 0, most = 0;
    /// The share of the squared noise that its worst pixels have, and how many these are:
    /// kWorstPixels, where the picture has a hundred times as many pixels, else a hundredth of
    /// them. Of a picture in parts, those of each part.
    double ofWorst = 0;
    uint64_t worstPixels = 0;

    bool known() const { return unknown == Unknown::No; }
};

/// A chi-square variable's quantile at the normal quantile z, for 3 degrees of freedom or more
/// (Wilson and Hilferty 1931); the lower one is too low, by 16 % at 3 and less from there on.
double chiSquareQuantile(double degrees, double z);

/// squaredErrors: estimates, by pixel and channel, of the squared error of its mean
/// (NoiseEstimate).
PictureNoise pictureNoise(const Film& film, std::span<const glm::dvec3> squaredErrors);

/// A part of a picture and what is known of its noise.
struct PartNoise {
    PictureNoise noise;
    uint64_t pixels = 0;
};

/// The noise of a picture in parts, each compared with its own mean radiance: known if that of
/// every part that is not black is.
PictureNoise togetherOf(std::span<const PartNoise> parts);

/// How far a picture still is from its limit, judged by its own samples.
///
/// A pixel's squared error after n samples is taken from what the last pass changed: if n grew to
/// N and the mean moved by d, then d^2 n / (N - n) has, for independent samples, the expectation
/// of the variance of the new mean (the variances of both means and of their difference add up).
/// For samples that fill the gaps of earlier ones, as Sobol points do, it is too large: by 1.8
/// where errors fall as N^-0.75, and by 3.7 at most in the bundled scenes (picture_noise.cpp allows
/// for it); Welford's variance over N would ignore the gain altogether. One pixel's estimate is as
/// rough as any from three numbers; the picture's is a mean over thousands.
class NoiseEstimate {
  public:
    /// What it remembers of the picture from one pass to the next.
    struct Memory {
        std::vector<uint32_t> counts; ///< as of the last update, by pixel; none yet: empty
        std::vector<glm::dvec3> means, squaredErrors;
    };

    /// Takes in what a pass changed. The first time there is nothing to compare with, and the
    /// variance of the samples is used.
    void update(const Film& film);

    const Memory& memory() const { return memory_; }
    /// Goes on from there; the pixels must be the same.
    void remember(Memory memory) { memory_ = std::move(memory); }

    PictureNoise picture(const Film& film) const;

    /// For each pixel of the film, the squared error times the number of samples, over squared
    /// radiance (with the floor): the variance of one sample, were they independent. Where Sobol
    /// points leave less of it, as at edges, fewer samples are worth taking. Means over the
    /// channels and the window of 7 x 7 pixels around it, itself left out. If its own samples had a
    /// say in their number, lucky ones would be diluted and unlucky ones kept, and the picture too
    /// dark: by 0.5 % where light is rare (Kirk and Arvo 1991). A pixel that has not met the light
    /// yet is judged by those around it.
    std::vector<double> relativeVariance(const Film& film) const;

  private:
    double meanRadiance(const Film& film) const;

    Memory memory_;
};

} // namespace stromboli
