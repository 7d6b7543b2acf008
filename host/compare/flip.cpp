#include "host/compare/flip.hpp"

#include "host/compare/flip_color.hpp"
#include "host/compare/plane.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace stromboli::compare {
namespace {

using std::numbers::pi;
using Channels = std::array<Plane, 3>;

Channels opponentChannels(const Picture& picture) {
    Channels channels;
    channels.fill(Plane(picture.width, picture.height));
    for (size_t i = 0; i < picture.rgb.size(); ++i) {
        const glm::dvec3 ycc =
            yccFromLinear(glm::clamp(picture.rgb[i], glm::dvec3(0), glm::dvec3(1)));
        for (int c = 0; c < 3; ++c)
            channels[size_t(c)].values[i] = ycc[c];
    }
    return channels;
}

/// Contrast sensitivity of one opponent channel (paper, table 1) as a filter in space: the sum of
/// two Gaussians a sqrt(pi / b) exp(-pi^2 d^2 / b), d the distance in degrees.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivities[3] = {
    {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
constexpr double kWidestB = 0.04;

/// Sum of unnormalised weights in two dimensions is the square of that in one.
double weightSum(double b, double pixelsPerDegree, int radius) {
    double sum = 0;
    for (int x = -radius; x <= radius; ++x)
        sum += std::exp(-pi * pi * x * x / (b * pixelsPerDegree * pixelsPerDegree));
    return sum * sum;
}

Plane seen(const Plane& plane, const Sensitivity& s, double pixelsPerDegree) {
    // Three standard deviations of the widest of all Gaussians, for every channel.
    const int radius = int(std::ceil(3 * std::sqrt(kWidestB / (2 * pi * pi)) * pixelsPerDegree));
    const auto blurred = [&](double b) {
        const Kernel k = gaussian(std::sqrt(b / (2 * pi * pi)) * pixelsPerDegree, radius);
        return filter(plane, k, k);
    };
    Plane first = blurred(s.b1);
    if (s.a2 == 0) return first;
    const Plane second = blurred(s.b2);
    const double w1 = s.a1 * std::sqrt(pi / s.b1) * weightSum(s.b1, pixelsPerDegree, radius);
    const double w2 = s.a2 * std::sqrt(pi / s.b2) * weightSum(s.b2, pixelsPerDegree, radius);
    for (size_t i = 0; i < first.values.size(); ++i)
        first.values[i] = (w1 * first.values[i] + w2 * second.values[i]) / (w1 + w2);
    return first;
}

/// What is left of the colours in the eye, in the space where they are compared.
std::vector<glm::dvec3> perceivedColors(const Channels& channels, double pixelsPerDegree) {
    Channels filtered;
    for (size_t c = 0; c < 3; ++c)
        filtered[c] = seen(channels[c], kSensitivities[c], pixelsPerDegree);
    std::vector<glm::dvec3> colors(channels[0].values.size());
    for (size_t i = 0; i < colors.size(); ++i) {
        const glm::dvec3 rgb =
            linearFromYcc({filtered[0].values[i], filtered[1].values[i], filtered[2].values[i]});
        colors[i] = huntLabFromLinear(glm::clamp(rgb, glm::dvec3(0), glm::dvec3(1)));
    }
    return colors;
}

/// Exponent and the two ends of the linear pieces that stretch small differences (section 4.1.3).
constexpr double kColorExponent = 0.7, kKneeIn = 0.4, kKneeOut = 0.95;

double colorError(const glm::dvec3& a, const glm::dvec3& b) {
    // No two colours of sRGB are farther apart than its green and its blue.
    static const double most =
        std::pow(hyAb(huntLabFromLinear({0, 1, 0}), huntLabFromLinear({0, 0, 1})), kColorExponent);
    const double error = std::pow(hyAb(a, b), kColorExponent), knee = kKneeIn * most;
    if (error < knee) return error * kKneeOut / knee;
    return kKneeOut + (error - knee) / (most - knee) * (1 - kKneeOut);
}

/// First and second derivative of a Gaussian, positive and negative weights each of sum 1.
Kernel derivative(double sigma, int radius, bool second) {
    Kernel kernel;
    double positive = 0, negative = 0;
    for (int x = -radius; x <= radius; ++x) {
        const double g = std::exp(-x * x / (2 * sigma * sigma));
        const double weight = second ? (x * x / (sigma * sigma) - 1) * g : -x * g;
        kernel.push_back(weight);
        (weight > 0 ? positive : negative) += std::abs(weight);
    }
    for (double& weight : kernel)
        weight /= weight > 0 ? positive : negative;
    return kernel;
}

/// Strength of edges, or of points, at each pixel of the achromatic channel.
Plane features(const Plane& achromatic, double pixelsPerDegree, bool points) {
    constexpr double kWidth = 0.082; // degrees, of the features the eye is most sensitive to
    const double sigma = 0.5 * kWidth * pixelsPerDegree;
    const int radius = int(std::ceil(3 * sigma));
    const Kernel across = derivative(sigma, radius, points), along = gaussian(sigma, radius);
    Plane x = filter(achromatic, across, along);
    const Plane y = filter(achromatic, along, across);
    for (size_t i = 0; i < x.values.size(); ++i)
        x.values[i] = std::hypot(x.values[i], y.values[i]);
    return x;
}

/// Y between 0 and 1.
Plane normalised(Plane achromatic) {
    for (double& y : achromatic.values)
        y = (y + 16) / 116;
    return achromatic;
}

std::vector<double> featureErrors(const Plane& a, const Plane& b, double pixelsPerDegree) {
    std::vector<double> errors(a.values.size(), 0);
    for (const bool points : {false, true}) {
        const Plane fa = features(a, pixelsPerDegree, points);
        const Plane fb = features(b, pixelsPerDegree, points);
        for (size_t i = 0; i < errors.size(); ++i)
            errors[i] = std::max(errors[i], std::abs(fa.values[i] - fb.values[i]));
    }
    for (double& error : errors)
        error = std::sqrt(error / std::numbers::sqrt2);
    return errors;
}

} // namespace

std::vector<double> flipMap(const Picture& reference, const Picture& picture,
                            double pixelsPerDegree) {
    const Channels a = opponentChannels(reference), b = opponentChannels(picture);
    const std::vector<glm::dvec3> colorsA = perceivedColors(a, pixelsPerDegree);
    const std::vector<glm::dvec3> colorsB = perceivedColors(b, pixelsPerDegree);
    const std::vector<double> feature =
        featureErrors(normalised(a[0]), normalised(b[0]), pixelsPerDegree);
    std::vector<double> map(colorsA.size());
    for (size_t i = 0; i < map.size(); ++i)
        map[i] = std::pow(colorError(colorsA[i], colorsB[i]), 1 - feature[i]);
    return map;
}

double meanOf(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return values.empty() ? 0 : sum / double(values.size());
}

} // namespace stromboli::compare
