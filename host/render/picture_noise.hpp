#pragma once

#include "host/film/film.hpp"

#include <span>

namespace stromboli {

/// Share of the picture's mean radiance m that is added, squared, to the squared value an error is
/// compared with, so that black pixels do not divide by zero: relMSE with epsilon = 0.01 m^2, as
/// `stromboli compare` computes it.
constexpr double kRelativeFloor = 0.1;

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
    /// A range that holds the noise in 95 of 100 renders (docs/estimator.md, "How noisy a picture
    /// is"; docs/results.md has the test of it).
    double least = 0, most = 0;

    bool known() const { return unknown == Unknown::No; }
};

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

} // namespace stromboli
