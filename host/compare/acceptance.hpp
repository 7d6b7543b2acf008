#pragma once

#include "host/compare/picture.hpp"

#include <cstdint>

namespace stromboli::compare {

/// How a picture stands against a reference of which the variance of one sample is known, by the
/// rule that Mitsuba 3 decides its render tests with. It is weak on small errors of the whole
/// picture, which the tests of means and blocks find where both pictures have variances.
struct Acceptance {
    uint64_t samples = 0;  ///< of each pixel of the picture
    double limit = 0;      ///< on |z|: twoSidedQuantile(1 - 0.99^(1 / pixels))
    uint64_t tests = 0;    ///< pixels times channels
    uint64_t passing = 0;  ///< of them, with |z| below the limit
    double required = 0;   ///< share of the tests that must pass
    double largest = 0;    ///< |z|; infinite where the picture is not finite
    uint32_t x = 0, y = 0; ///< the pixel of the largest one

    double share() const { return double(passing) / double(tests); }
    bool accepted() const { return double(passing) >= required * double(tests); }
};

/// z = |picture - reference| / sqrt(max(variance, 1e-4) / samples) in CIE XYZ. `variance`: of one
/// sample of the reference, taken in XYZ and stored as linear sRGB, so that it may have negative
/// channels. The reference's own noise is ignored, as the rule has it, up to kIgnoredBelow samples;
/// beyond it counts as that of kReferenceSamples samples. Throws UsageError if sizes differ.
Acceptance judgeByVariance(const Picture& reference, const Picture& variance,
                           const Picture& picture, uint64_t samples);

/// Variances of a sample below this are noise of their own estimate, or those of pixels that hardly
/// vary.
inline constexpr double kLeastSampleVariance = 1e-4;

/// Throws UsageError, which calls `other` by the name `what`, unless it has the reference's size.
void requireSameSize(const Picture& reference, const Picture& other, const char* what);

inline constexpr uint64_t kIgnoredBelow = 4096;
/// What Mitsuba's references are about as good as.
inline constexpr double kReferenceSamples = 32000;

} // namespace stromboli::compare
