#pragma once

#include "host/check/cross_check.hpp"
#include "host/compare/flip.hpp"
#include "host/compare/metrics.hpp"
#include "host/core/json.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::compare {

// --- Acceptance tests ----------------------------------------------------------------------------

/// From linear RGB with ITU-R BT.709 primaries and white D65 to CIE XYZ (IEC 61966-2-1); columns.
inline const glm::dmat3 kXyzFromLinear{0.412453, 0.212671, 0.019334, 0.357580, 0.715160,
                                       0.119193, 0.180423, 0.072169, 0.950227};

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

// --- Comparisons ---------------------------------------------------------------------------------

struct CompareSettings {
    double exposure = 0; ///< stops, for what looks at sRGB signals: PSNR, SSIM
    double pixelsPerDegree = kFlipPixelsPerDegree;
    double familyError = 0.01; ///< of the z-tests: probability of a false alarm
};

/// All that is known of how a picture differs from a reference.
struct Comparison {
    uint32_t width = 0, height = 0;
    /// Pixels that are NaN or infinite in either picture; they are left out of all that follows
    /// (both pictures are taken to be black there).
    uint64_t notFiniteReference = 0, notFinitePicture = 0;
    uint64_t notFiniteInPictureAlone = 0; ///< where the reference is finite
    uint64_t compared = 0;                ///< pixels that are finite in both
    LinearErrors errors;
    double psnr = 0; ///< dB
    double ssim = 0;
    double flip = 0; ///< mean of `flipMap`
    std::vector<double> flipMap;
    /// HDR-FLIP if both pictures are linear, else FLIP.
    bool highDynamicRange = false;
    double flipStartStops = 0, flipStopStops = 0;
    int flipExposures = 1;
    std::optional<CheckResult> zTest;               ///< where both have variances; A is the picture
    std::optional<Acceptance> acceptance;           ///< where a variance of the reference is given
    std::optional<BlockAcceptance> blockAcceptance; ///< likewise
    uint32_t branches = 1;      ///< paths of a sample, the larger one of the two pictures
    bool unevenSamples = false; ///< sample counts vary: adaptive sampling
};

/// Throws UsageError if the sizes differ.
Comparison comparePictures(const Picture& reference, const Picture& picture,
                           const CompareSettings& settings);

/// Limits whose violation fails a comparison.
struct Thresholds {
    std::optional<double> mse, relMse, flip, biasPercent; ///< at most
    std::optional<double> psnr, ssim;                     ///< at least
    bool zTest = false;                                   ///< must agree
    bool blocks = false;                                  ///< BlockAcceptance must accept
    bool any() const {
        return mse || relMse || flip || biasPercent || psnr || ssim || zTest || blocks;
    }
};

/// A line for each limit that is not kept, and one if the picture is not accepted; a figure that is
/// NaN keeps none. No limit is kept by a picture that is not finite in a pixel where the reference
/// is, or in all of them. Throws UsageError for a z-test without variances.
std::vector<std::string> violations(const Comparison& comparison, const Thresholds& thresholds);

std::string toText(const Comparison& comparison);
Json toJson(const Comparison& comparison);
/// Of the picture, then of the blocks and pixels, in standard deviations.
Json toJson(const CheckResult& zTests);

} // namespace stromboli::compare
