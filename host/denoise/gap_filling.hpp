#pragma once

#include "host/film/film.hpp"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace stromboli::denoise {

/// How much of the squared errors that a half of the samples tells of is there, by pixel, 1 at
/// most.
///
/// Sobol points fill each other's gaps, so that the errors of two halves cancel in part. If the
/// variance of a mean of n falls as n^-b, that of the mean of both halves is 1 / (2^b - 1) of what
/// their difference says: all of it for independent samples (b = 1). b follows from how the
/// difference compares with what the samples' own variance says, over the pixels around: their
/// ratio is 2 n^(1 - b) (1 - 2^-b), n being the number of samples in a half.
std::vector<float> sharesOfErrors(const Film& film, std::span<const glm::dvec3> squaredErrors);

/// 1 / (2^b - 1) for b from 1 to 3 with that ratio.
double shareOfError(double ratio, double samplesInHalf);

} // namespace stromboli::denoise
