#include "host/compare/acceptance.hpp"

#include "host/check/normal.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace stromboli::compare {
namespace {

constexpr double kFamilyError = 0.01;
constexpr double kRequired = 0.9975;
/// Variances below this are noise of their own estimate, or those of pixels that hardly vary.
constexpr double kLeastVariance = 1e-4;

/// ITU-R BT.709 primaries, white D65 (IEC 61966-2-1).
glm::dvec3 xyzFromLinear(const glm::dvec3& c) {
    return {0.412453 * c.x + 0.357580 * c.y + 0.180423 * c.z,
            0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z,
            0.019334 * c.x + 0.119193 * c.y + 0.950227 * c.z};
}

void requireSize(const Picture& reference, const Picture& other, const char* what) {
    if (other.width != reference.width || other.height != reference.height)
        throw UsageError(fmt::format("the reference has {} x {} pixels, {} {} x {}",
                                     reference.width, reference.height, what, other.width,
                                     other.height));
}

} // namespace

Acceptance judgeByVariance(const Picture& reference, const Picture& variance,
                           const Picture& picture, uint64_t samples) {
    requireSize(reference, variance, "its variance");
    requireSize(reference, picture, "the picture");
    Acceptance result;
    result.samples = samples;
    result.limit = twoSidedQuantile(sidakLevel(kFamilyError, reference.rgb.size()));
    result.tests = 3 * reference.rgb.size();
    result.required = kRequired;
    const double perSample =
        1 / double(samples) + (samples > kIgnoredBelow ? 1 / kReferenceSamples : 0);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const glm::dvec3 difference = xyzFromLinear(picture.rgb[i] - reference.rgb[i]);
        const glm::dvec3 ofSample = xyzFromLinear(variance.rgb[i]);
        for (int c = 0; c < 3; ++c) {
            const double deviation = std::sqrt(std::fmax(ofSample[c], kLeastVariance) * perSample);
            double z = std::abs(difference[c]) / deviation;
            if (!std::isfinite(z)) z = std::numeric_limits<double>::infinity();
            if (z < result.limit) ++result.passing;
            if (z <= result.largest) continue;
            result.largest = z;
            result.x = uint32_t(i % reference.width);
            result.y = uint32_t(i / reference.width);
        }
    }
    return result;
}

} // namespace stromboli::compare
