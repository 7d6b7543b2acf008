#pragma once

#include "host/check/cross_check.hpp"
#include "host/compare/acceptance.hpp"
#include "host/compare/flip.hpp"
#include "host/compare/metrics.hpp"
#include "host/core/json.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stromboli::compare {

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

} // namespace stromboli::compare
