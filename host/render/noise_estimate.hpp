#pragma once

#include "host/film/film.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

/// Share of the picture's mean radiance m that is added, squared, to the squared value an error is
/// compared with, so that black pixels do not divide by zero: relMSE with epsilon = 0.01 m^2, as
/// `stromboli compare` computes it.
constexpr double kRelativeFloor = 0.1;

/// How far a picture still is from its limit, judged by its own samples.
///
/// A pixel's squared error after n samples is taken from what the last pass changed: if n grew to
/// N and the mean moved by d, then d^2 n / (N - n) has, for independent samples, the expectation
/// of the variance of the new mean (the variances of both means and of their difference add up).
/// For samples that fill the gaps of earlier ones, as Sobol points do, it is too large, by 1.8 at
/// most where errors fall as N^-0.75, and right where they fall as N^-0.5; Welford's variance over
/// N would ignore the gain altogether. One pixel's estimate is as rough as any from
/// three numbers; the picture's is a mean over thousands.
class NoiseEstimate {
  public:
    /// What it remembers of the picture from one pass to the next.
    struct Memory {
        std::vector<uint32_t> counts; ///< as of the last update, by place in the list of pixels
        std::vector<glm::dvec3> means, squaredErrors;
    };

    /// pixels: those that are rendered, as indices in the film.
    explicit NoiseEstimate(std::vector<uint32_t> pixels);

    /// Takes in what a pass changed. The first time there is nothing to compare with, and the
    /// variance of the samples is used.
    void update(const Film& film);

    const Memory& memory() const { return memory_; }
    /// Goes on from there; the pixels must be the same.
    void remember(Memory memory) { memory_ = std::move(memory); }

    /// Square root of the expected relMSE of the picture, a fraction: 0.02 is 2 % of noise.
    double picture(const Film& film) const;

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

    std::vector<uint32_t> pixels_;
    Memory memory_;
};

} // namespace stromboli
