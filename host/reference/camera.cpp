#include "host/reference/camera.hpp"

#include "host/reference/sampling.hpp"
#include "shaders/shared/interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>

namespace stromboli::reference {

// --- Camera rays ---------------------------------------------------------------------------------

Ray cameraRay(const Camera& camera, double s, double t, const glm::dvec2& onLens) {
    const glm::dvec3 offset = ((2 * s - 1) * camera.halfWidth + camera.shift.x) * camera.right +
                              ((1 - 2 * t) * camera.halfHeight + camera.shift.y) * camera.up;
    Ray ray;
    if (camera.orthographic) {
        ray.origin = camera.position + offset;
        ray.direction = -camera.back;
    } else {
        ray.origin =
            camera.position + camera.lensRadius * (onLens.x * camera.right + onLens.y * camera.up);
        const glm::dvec3 sharp = camera.position + camera.focusDistance * (offset - camera.back);
        ray.direction = glm::normalize(sharp - ray.origin);
    }
    const double depthPerLength = camera.clipAlongRay ? 1 : -glm::dot(ray.direction, camera.back);
    ray.tMin = camera.nearDistance / depthPerLength;
    ray.tMax = camera.farDistance / depthPerLength;
    return ray;
}

// --- Pixel filters -------------------------------------------------------------------------------

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

/// A number of the density 1 - |x| on [-1, 1], by inversion.
double sampleTent(double u) {
    return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
}

/// Mitchell and Netravali's filter as a spline, by powers of the distance (their equation 8).
double cubic(double x, double b, double c) {
    const std::array<double, 4> inner = {6 - 2 * b, 0, -18 + 12 * b + 6 * c, 12 - 9 * b - 6 * c};
    const std::array<double, 4> outer = {8 * b + 24 * c, -12 * b - 48 * c, 6 * b + 30 * c,
                                         -b - 6 * c};
    const std::array<double, 4>& p = x < 1 ? inner : outer;
    return (p[0] + x * (p[1] + x * (p[2] + x * p[3]))) / 6;
}

/// The spectrum of a box.
double sinc(double x) {
    return x == 0 ? 1 : std::sin(kPi * x) / (kPi * x);
}

/// Stretches on each pixel, of which changes of sign cut some in two.
constexpr int kStretches = 64;

} // namespace

FilterSampler::FilterSampler(PixelFilter filter, const FilterShape& shape)
    : filter_(filter), shape_(shape) {
    if (filter == PixelFilter::CatmullRom) shape_.b = 0, shape_.c = 0.5;
    if (!hasNegativeLobes(filter)) return;
    radius_ = filter == PixelFilter::Lanczos ? shape.lobes : 2;
    integrate();
}

double FilterSampler::at(double x) const {
    x = std::abs(x);
    if (filter_ == PixelFilter::Lanczos) return sinc(x) * sinc(x / radius_);
    return cubic(x, shape_.b, shape_.c);
}

/// Gauss and Legendre's rule of three points: exact for the cubics, and on such short stretches of
/// a sinc as good as doubles.
double FilterSampler::integral(double from, double to) const {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    const double aside = half * std::sqrt(0.6);
    return half / 9 * (5 * at(middle - aside) + 8 * at(middle) + 5 * at(middle + aside));
}

void FilterSampler::integrate() {
    double filter = 0, absolute = 0;
    const auto add = [&](double from, double to) {
        const double piece = integral(from, to);
        filter += 2 * piece, absolute += 2 * std::abs(piece);
        const double sign = piece < 0 ? -1 : 1;
        stretches_.push_back({from, to, sign, 0});
        stretches_.push_back({-to, -from, sign, 0});
    };
    const int count = int(radius_) * kStretches;
    for (int i = 0; i < count; ++i) {
        const double from = radius_ * i / count, to = radius_ * (i + 1) / count;
        double low = from, high = to;
        if (at(from) * at(to) < 0)
            while (0.5 * (low + high) > low && 0.5 * (low + high) < high) {
                const double middle = 0.5 * (low + high);
                ((at(middle) < 0) == (at(from) < 0) ? low : high) = middle;
            }
        if (low > from) add(from, low);
        add(low, to);
    }
    ratio_ = absolute / filter;
    std::ranges::sort(stretches_, [](const Stretch& a, const Stretch& b) {
        return std::tuple(-a.sign, a.from) < std::tuple(-b.sign, b.from);
    });
    double sum = 0;
    for (Stretch& stretch : stretches_)
        stretch.sum = sum += std::abs(integral(stretch.from, stretch.to));
}

FilterSampler::Weighted FilterSampler::sampleSigned(double u) const {
    const double wanted = u * stretches_.back().sum;
    const auto found =
        std::upper_bound(stretches_.begin(), stretches_.end() - 1, wanted,
                         [](double value, const Stretch& stretch) { return value < stretch.sum; });
    const double rest = wanted - (found == stretches_.begin() ? 0 : std::prev(found)->sum);
    double low = found->from, high = found->to;
    for (int i = 0; i < 52; ++i) {
        const double middle = 0.5 * (low + high);
        (std::abs(integral(found->from, middle)) < rest ? low : high) = middle;
    }
    return {low, found->sign};
}

FilterSample FilterSampler::sample(double u, double v) const {
    const double width = 2 * double(gpu::BLACKMAN_HARRIS_RADIUS);
    switch (filter_) {
    case PixelFilter::Box:
        break;
    case PixelFilter::Gaussian:
        return {0.5 + shape_.width * sampleGaussian(u, v)};
    case PixelFilter::Tent:
        return {0.5 + shape_.width * glm::dvec2(sampleTent(u), sampleTent(v))};
    case PixelFilter::BlackmanHarris:
        return {0.5 + width * (glm::dvec2(sampleBlackmanHarris(u), sampleBlackmanHarris(v)) - 0.5)};
    case PixelFilter::Mitchell:
    case PixelFilter::CatmullRom:
    case PixelFilter::Lanczos: {
        const auto [x, signX] = sampleSigned(u);
        const auto [y, signY] = sampleSigned(v);
        return {{0.5 + x, 0.5 + y}, signX * signY * ratio_ * ratio_};
    }
    }
    return {{u, v}};
}

} // namespace stromboli::reference
