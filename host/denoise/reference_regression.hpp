#pragma once

#include "host/denoise/prepare.hpp"

#include <glm/glm.hpp>

#include <span>

namespace stromboli::denoise {

/// What the radiance of a pixel is compared by.
struct Pilot {
    glm::dvec3 first{0.0}, second{0.0}; ///< of either half
    double variance = 0;                ///< of either, summed over channels
    double noise = 0;                   ///< mean squared deviation of a pixel, by channel
};

/// By how much the squared difference of two pilots exceeds what their variances explain: of the
/// first and of the second half.
glm::dvec2 excess(const Pilot& own, const Pilot& other);

/// What a candidate changes of the mean, and half of what its two halves differ by.
struct Candidate {
    glm::dvec3 change{0.0}, deviation{0.0};
};

/// The candidate that is a weighted linear regression of radiance on albedo, normals and place
/// (docs/theory/denoising.md, "Candidates"), for the pixel in column x of row y. pilots: of all
/// pixels.
Candidate regressionAt(const Prepared& picture, std::span<const Pilot> pilots, int x, int y);

} // namespace stromboli::denoise
