#include "host/compare/flip.hpp"

#include "host/core/color.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stromboli::compare {

// --- FLIP ----------------------------------------------------------------------------------------

namespace {

/// Filters along x and exchanges x and y: done twice, it filters along both.
Plane filterAndTranspose(const Plane& plane, const Kernel& kernel) {
    Plane out(plane.height, plane.width);
    const int radius = int(kernel.size() / 2), last = int(plane.width) - 1;
    tbb::parallel_for(uint32_t(0), plane.height, [&](uint32_t y) {
        const double* row = &plane.values[size_t(y) * plane.width];
        for (int x = 0; x <= last; ++x) {
            double sum = 0;
            for (int i = -radius; i <= radius; ++i)
                sum += kernel[size_t(i + radius)] * row[std::clamp(x + i, 0, last)];
            out.values[size_t(x) * plane.height + y] = sum;
        }
    });
    return out;
}

} // namespace

Kernel gaussian(double sigma, int radius) {
    Kernel kernel;
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
        kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
        sum += kernel.back();
    }
    for (double& weight : kernel)
        weight /= sum;
    return kernel;
}

Plane filter(const Plane& plane, const Kernel& alongX, const Kernel& alongY) {
    return filterAndTranspose(filterAndTranspose(plane, alongX), alongY);
}

namespace {

/// IEC 61966-2-1's primaries and white point D65, (x, y) = (0.3127, 0.3290), as exact fractions:
/// XYZ of linear RGB. Column by column, as GLM stores it.
const glm::dmat3 kXyzFromRgb = {10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382,
                                8788810.0 / 24577794,  8788810.0 / 12288897, 8788810.0 / 73733382,
                                4435075.0 / 24577794,  887015.0 / 12288897,  70074185.0 / 73733382};
const glm::dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const glm::dvec3 kWhite = kXyzFromRgb * glm::dvec3(1);

double labCurve(double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

} // namespace

glm::dvec3 yccFromLinear(const glm::dvec3& rgb) {
    const glm::dvec3 t = kXyzFromRgb * rgb / kWhite;
    return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}

glm::dvec3 linearFromYcc(const glm::dvec3& ycc) {
    const double y = (ycc.x + 16) / 116;
    const glm::dvec3 t = {y + ycc.y / 500, y, y - ycc.z / 200};
    return kRgbFromXyz * (t * kWhite);
}

glm::dvec3 huntLabFromLinear(const glm::dvec3& rgb) {
    const glm::dvec3 t = kXyzFromRgb * rgb / kWhite;
    const double fy = labCurve(t.y), lightness = 116 * fy - 16;
    return {lightness, 0.01 * lightness * 500 * (labCurve(t.x) - fy),
            0.01 * lightness * 200 * (fy - labCurve(t.z))};
}

double hyAb(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = a - b;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

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

namespace {

/// ACES tone curve in Narkowicz's fit (2015), a ratio of two quadratics; its input is scaled by
/// 0.6 to undo the fit's exposure, as the HDR-FLIP paper does.
constexpr double kScale = 0.6;
constexpr double kN2 = 2.51 * kScale * kScale, kN1 = 0.03 * kScale;
constexpr double kD2 = 2.43 * kScale * kScale, kD1 = 0.59 * kScale, kD0 = 0.14;

double tone(double x) {
    return std::clamp((kN2 * x * x + kN1 * x) / (kD2 * x * x + kD1 * x + kD0), 0.0, 1.0);
}

/// Where the curve reaches 0.85, the paper's limit of what is still well exposed: the positive
/// root of the quadratic equation tone(x) = 0.85.
double wellExposed() {
    constexpr double kLimit = 0.85;
    constexpr double a = kN2 - kLimit * kD2, b = kN1 - kLimit * kD1, c = -kLimit * kD0;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

Picture toned(const Picture& picture, double stops) {
    Picture out = picture;
    const double exposure = std::exp2(stops);
    for (glm::dvec3& c : out.rgb)
        for (int i = 0; i < 3; ++i)
            c[i] = tone(exposure * std::max(c[i], 0.0));
    return out;
}

double medianOf(std::vector<double> values) {
    const size_t half = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The curve's input is what the paper scales, so a black picture has no range: one exposure.
HdrFlip exposureRange(const Picture& reference) {
    std::vector<double> luminances;
    for (const glm::dvec3& c : reference.rgb)
        luminances.push_back(luminance(c));
    const double most = *std::max_element(luminances.begin(), luminances.end());
    HdrFlip range;
    range.exposures = 1;
    if (!(most > 0)) return range;
    // Not more than 2^-20 of the brightest, for pictures that are mostly black.
    const double median = std::max(medianOf(std::move(luminances)), most * 0x1p-20);
    range.startStops = std::log2(wellExposed() / most);
    range.stopStops = std::log2(wellExposed() / median);
    range.exposures = std::max(2, int(std::ceil(range.stopStops - range.startStops)));
    return range;
}

} // namespace

HdrFlip hdrFlipMap(const Picture& reference, const Picture& picture, double pixelsPerDegree) {
    HdrFlip result = exposureRange(reference);
    result.map.assign(reference.rgb.size(), 0);
    const double step = (result.stopStops - result.startStops) / std::max(result.exposures - 1, 1);
    for (int i = 0; i < result.exposures; ++i) {
        const double stops = result.startStops + i * step;
        const std::vector<double> map =
            flipMap(toned(reference, stops), toned(picture, stops), pixelsPerDegree);
        for (size_t p = 0; p < map.size(); ++p)
            result.map[p] = std::max(result.map[p], map[p]);
    }
    return result;
}

// --- False colours -------------------------------------------------------------------------------

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
