#include "host/compare/false_color.hpp"

#include "host/compare/metrics.hpp"
#include "host/core/color.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stromboli::compare {
namespace {

void put(ByteImage& image, size_t pixel, const glm::dvec3& signal) {
    for (int c = 0; c < 3; ++c)
        image.rgb[3 * pixel + size_t(c)] = uint8_t(255 * std::clamp(signal[c], 0.0, 1.0) + 0.5);
}

} // namespace

glm::dvec3 cubehelix(double value) {
    const double t = value > 0 ? std::min(value, 1.0) : 0;
    const double angle = 2 * std::numbers::pi * (0.5 / 3 + 1 - 1.5 * t);
    const double amplitude = t * (1 - t) / 2;
    const double x = std::cos(angle), y = std::sin(angle);
    // Green's equation 2: a circle about the grey diagonal of constant perceived brightness.
    return {t + amplitude * (-0.14861 * x + 1.78277 * y),
            t + amplitude * (-0.29227 * x - 0.90649 * y), t + amplitude * 1.97294 * x};
}

glm::dvec3 blueWhiteRed(double value) {
    const double v = std::clamp(value, -1.0, 1.0), rest = 1 - std::abs(v);
    return v > 0 ? glm::dvec3(1, rest, rest) : glm::dvec3(rest, rest, 1);
}

ByteImage falseColor(std::span<const double> values, uint32_t width, uint32_t height, double top) {
    ByteImage image(width, height);
    for (size_t i = 0; i < values.size(); ++i)
        put(image, i, cubehelix(top > 0 ? values[i] / top : 0));
    return image;
}

ByteImage signedDifference(const Picture& reference, const Picture& picture) {
    // A tenth of the mean, squared, is what relMSE adds to the squared reference.
    const double floor = std::sqrt(relativeEpsilon(reference));
    ByteImage image(reference.width, reference.height);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const double r = luminance(reference.rgb[i]), d = luminance(picture.rgb[i]) - r;
        put(image, i, blueWhiteRed(d == 0 ? 0 : d / (r + floor)));
    }
    return image;
}

} // namespace stromboli::compare
