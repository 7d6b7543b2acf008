#include "host/reference/pixel_filter.hpp"

#include "host/reference/sampling.hpp"
#include "shaders/shared/interface.h"

#include <cmath>

namespace stromboli::reference {
namespace {

/// The four-term Blackman-Harris window on [0, 1], integrated from 0 and divided by the whole.
double blackmanHarrisIntegral(double t) {
    const double a0 = 0.35875, a1 = 0.48829, a2 = 0.14128, a3 = 0.01168;
    return (a0 * t - a1 * std::sin(2 * kPi * t) / (2 * kPi) +
            a2 * std::sin(4 * kPi * t) / (4 * kPi) - a3 * std::sin(6 * kPi * t) / (6 * kPi)) /
           a0;
}

double sampleBlackmanHarris(double u) {
    double low = 0, high = 1;
    for (int i = 0; i < 52; ++i) {
        const double middle = 0.5 * (low + high);
        (blackmanHarrisIntegral(middle) < u ? low : high) = middle;
    }
    return low;
}

/// Normally distributed in two dimensions, conditional on its distance from the middle.
glm::dvec2 sampleGaussian(double u, double v) {
    const double deviations = double(gpu::GAUSSIAN_RADIUS) / gpu::GAUSSIAN_DEVIATION;
    const double within = 1 - std::exp(-deviations * deviations / 2);
    const double radius = gpu::GAUSSIAN_DEVIATION * std::sqrt(-2 * std::log(1 - u * within));
    return {radius * std::cos(2 * kPi * v), radius * std::sin(2 * kPi * v)};
}

/// Of the density 1 - |x|.
double sampleTent(double u) {
    return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
}

} // namespace

glm::dvec2 placeInPixel(PixelFilter filter, double u, double v) {
    const double width = 2 * double(gpu::BLACKMAN_HARRIS_RADIUS);
    switch (filter) {
    case PixelFilter::Box:
        break;
    case PixelFilter::Gaussian:
        return 0.5 + sampleGaussian(u, v);
    case PixelFilter::Tent:
        return {0.5 + sampleTent(u), 0.5 + sampleTent(v)};
    case PixelFilter::BlackmanHarris:
        return 0.5 + width * (glm::dvec2(sampleBlackmanHarris(u), sampleBlackmanHarris(v)) - 0.5);
    }
    return {u, v};
}

} // namespace stromboli::reference
