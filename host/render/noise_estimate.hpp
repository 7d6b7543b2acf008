#pragma once

#include "host/film/film.hpp"
#include "host/render/picture_noise.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

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
