#pragma once

#include "host/compare/picture.hpp"

#include <cstdint>

namespace stromboli::compare {

/// How the sums of many pixels stand against a reference of which the variance of one sample is
/// known: of the whole picture, and of blocks of 8 x 8 pixels. Stricter than Acceptance, which sees
/// single pixels and forgives 1 in 400: what is off by half of each pixel's noise is off by four
/// times a block's.
struct BlockAcceptance {
    static constexpr uint32_t kSide = 8; ///< of a block, in pixels

    double familyError = 0;   ///< probability that a right picture fails
    double limit = 0;         ///< on |z|, of all tests: the means' and the blocks'
    uint64_t tests = 0;       ///< 3 channels (CIE X, Y, Z) of the picture and of each block
    glm::dvec3 means{0.0};    ///< z of the picture's X, Y, Z
    glm::dvec3 errors{0.0};   ///< of the picture's red, green, blue, relative to the reference's
    glm::dvec3 noise{0.0};    ///< standard deviation of X, Y, Z, relative
    double largest = 0;       ///< |z| of a block; infinite where the picture is not finite
    uint32_t x = 0, y = 0;    ///< that block's first pixel
    bool hasOwnNoise = false; ///< the picture's noise is by its own variances

    /// The largest |z| of all tests.
    double worst() const;
    bool accepted() const { return worst() < limit; }
};

/// z = sum(picture - reference) / sqrt(sum of both pictures' variances). The reference's: that of
/// one sample (Acceptance) over `referenceSamples`. The picture's: its own where it has variances,
/// of which only those of red, green and blue are known, so that X, Y and Z have the largest that
/// these allow (as if the channels' noise were the same); else that of the reference over
/// `samples`. Variances have Acceptance's least value. Throws UsageError if sizes differ.
BlockAcceptance judgeBlocks(const Picture& reference, const Picture& variance,
                            const Picture& picture, uint64_t samples, double referenceSamples,
                            double familyError);

} // namespace stromboli::compare
