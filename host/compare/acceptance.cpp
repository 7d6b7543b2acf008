#include "host/compare/acceptance.hpp"

#include "host/check/normal.hpp"
#include "host/compare/cie_xyz.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace stromboli::compare {
namespace {

constexpr double kFamilyError = 0.01;
constexpr double kRequired = 0.9975;
} // namespace

void requireSameSize(const Picture& reference, const Picture& other, const char* what) {
    if (other.width != reference.width || other.height != reference.height)
        throw UsageError(fmt::format("the reference has {} x {} pixels, {} {} x {}",
                                     reference.width, reference.height, what, other.width,
                                     other.height));
}

Acceptance judgeByVariance(const Picture& reference, const Picture& variance,
                           const Picture& picture, uint64_t samples) {
    requireSameSize(reference, variance, "its variance");
    requireSameSize(reference, picture, "the picture");
    Acceptance result;
    result.samples = samples;
    result.limit = twoSidedQuantile(sidakLevel(kFamilyError, reference.rgb.size()));
    result.tests = 3 * reference.rgb.size();
    result.required = kRequired;
    const double perSample =
        1 / double(samples) + (samples > kIgnoredBelow ? 1 / kReferenceSamples : 0);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const glm::dvec3 difference = kXyzFromLinear * (picture.rgb[i] - reference.rgb[i]);
        const glm::dvec3 ofSample = kXyzFromLinear * variance.rgb[i];
        for (int c = 0; c < 3; ++c) {
            const double deviation =
                std::sqrt(std::fmax(ofSample[c], kLeastSampleVariance) * perSample);
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
