#include "host/compare/acceptance.hpp"

#include "host/check/cross_check.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
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

namespace {

/// Of some pixels, in XYZ.
struct Sum {
    glm::dvec3 difference{0.0}, variance{0.0};

    void operator+=(const Sum& other) {
        difference += other.difference;
        variance += other.variance;
    }
    glm::dvec3 z() const {
        glm::dvec3 z = difference / glm::sqrt(variance);
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(z[c])) z[c] = std::numeric_limits<double>::infinity();
        return z;
    }
};

/// The largest variance that X, Y and Z can have if red, green and blue have these.
glm::dvec3 largestInXyz(const glm::dvec3& variance) {
    const glm::dvec3 deviation = kXyzFromLinear * glm::sqrt(variance);
    return deviation * deviation;
}

Sum sumOfPixel(const Picture& reference, const Picture& variance, const Picture& picture, size_t i,
               uint64_t samples, double referenceSamples) {
    const glm::dvec3 ofSample =
        glm::max(kXyzFromLinear * variance.rgb[i], glm::dvec3(kLeastSampleVariance));
    const glm::dvec3 own = picture.film ? largestInXyz(picture.film->pixels[i].varianceOfMean())
                                        : ofSample / double(samples);
    return {kXyzFromLinear * (picture.rgb[i] - reference.rgb[i]),
            own + ofSample / referenceSamples};
}

double largestOf(const glm::dvec3& z) {
    return std::max({std::abs(z.x), std::abs(z.y), std::abs(z.z)});
}

} // namespace

double BlockAcceptance::worst() const {
    return std::max(largest, largestOf(means));
}

BlockAcceptance judgeBlocks(const Picture& reference, const Picture& variance,
                            const Picture& picture, uint64_t samples, double referenceSamples,
                            double familyError) {
    requireSameSize(reference, variance, "its variance");
    requireSameSize(reference, picture, "the picture");
    constexpr uint32_t kSide = BlockAcceptance::kSide;
    const uint32_t across = (reference.width + kSide - 1) / kSide,
                   down = (reference.height + kSide - 1) / kSide;
    std::vector<Sum> blocks(size_t(across) * down);
    Sum all;
    glm::dvec3 difference(0.0), expected(0.0);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const Sum pixel = sumOfPixel(reference, variance, picture, i, samples, referenceSamples);
        const size_t x = i % reference.width / kSide, y = i / reference.width / kSide;
        blocks[y * across + x] += pixel;
        all += pixel;
        difference += picture.rgb[i] - reference.rgb[i];
        expected += reference.rgb[i];
    }
    BlockAcceptance result;
    result.familyError = familyError;
    result.tests = 3 * (blocks.size() + 1);
    result.limit = twoSidedQuantile(sidakLevel(familyError, result.tests));
    result.means = all.z();
    result.errors = difference / expected;
    result.noise = glm::sqrt(all.variance) / (kXyzFromLinear * expected);
    result.hasOwnNoise = picture.film.has_value();
    for (size_t i = 0; i < blocks.size(); ++i) {
        const double z = largestOf(blocks[i].z());
        if (z <= result.largest) continue;
        result.largest = z;
        result.x = uint32_t(i % across) * kSide;
        result.y = uint32_t(i / across) * kSide;
    }
    return result;
}

} // namespace stromboli::compare
