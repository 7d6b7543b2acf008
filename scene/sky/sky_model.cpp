#include "scene/sky/sky_model.hpp"

#include "third_party/hosek_wilkie_sky/sky_rgb.inc"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::sky {
namespace {

constexpr size_t kAlbedos = 2, kPoints = 6, kChannels = 3, kShape = 9;
constexpr size_t kPieces = 45, kPowers = 4; // of the sun

/// In Mitsuba's unit equal power at all wavelengths has luminance 1: the tables divided by the
/// integral of the CIE 1931 curve of luminance, in nm.
constexpr double kUnit = 1 / 106.7502593994140625;
/// The tables have the sun in another unit than the sky; Mitsuba has measured the ratio.
constexpr double kSunUnit = 467.069280386 * kUnit;

/// Between the numbers for turbidities 1, 2, ..., 10.
struct Between {
    size_t below;
    double share;
};
Between turbidityAt(double turbidity) {
    const auto below = size_t(std::clamp(turbidity - 1, 0.0, 8.0));
    return {below, turbidity - 1 - double(below)};
}

/// The cube root of the sun's elevation, of which a right angle is 1: by that the models have their
/// control points and pieces.
double rootOf(double elevation) {
    return std::cbrt(std::clamp(elevation * 2 / glm::pi<double>(), 0.0, 1.0));
}

/// Bernstein's polynomials of degree 5.
std::array<double, kPoints> weightsAt(double x) {
    constexpr std::array<double, kPoints> kBinomials = {1, 5, 10, 10, 5, 1};
    std::array<double, kPoints> weights;
    for (size_t i = 0; i < kPoints; ++i)
        weights[i] = kBinomials[i] * std::pow(x, double(i)) * std::pow(1 - x, double(5 - i));
    return weights;
}

/// Numbers of a table by turbidity, albedo, control point, channel and parameter, `count` of the
/// last, at some place among the first three.
double interpolated(const float* table, size_t count, const Between& turbidity, double albedo,
                    const std::array<double, kPoints>& weights, size_t channel, size_t parameter) {
    double sum = 0;
    for (size_t t = 0; t < 2; ++t)
        for (size_t a = 0; a < kAlbedos; ++a)
            for (size_t p = 0; p < kPoints; ++p) {
                const size_t row = ((turbidity.below + t) * kAlbedos + a) * kPoints + p;
                sum += (t == 1 ? turbidity.share : 1 - turbidity.share) *
                       (a == 1 ? albedo : 1 - albedo) * weights[p] *
                       double(table[(row * kChannels + channel) * count + parameter]);
            }
    return sum;
}

/// A piece is a polynomial of the elevation above where it begins.
double sunAt(const Between& turbidity, double elevation, size_t channel) {
    const size_t piece = std::min(size_t(rootOf(elevation) * double(kPieces)), kPieces - 1);
    const double begin = std::pow(double(piece) / double(kPieces), 3) * glm::half_pi<double>();
    double sum = 0;
    for (size_t t = 0; t < 2; ++t)
        for (size_t power = 0; power < kPowers; ++power) {
            const size_t row = ((turbidity.below + t) * kPieces + piece) * kChannels + channel;
            sum += (t == 1 ? turbidity.share : 1 - turbidity.share) *
                   double(kSunRadiance[row * kPowers + power]) *
                   std::pow(elevation - begin, double(power));
        }
    return sum;
}

} // namespace

SkyModel::SkyModel(double turbidity, const glm::dvec3& albedo, double sunElevation) {
    const Between between = turbidityAt(turbidity);
    const std::array<double, kPoints> weights = weightsAt(rootOf(sunElevation));
    for (size_t c = 0; c < kChannels; ++c) {
        const double a = albedo[glm::length_t(c)];
        for (size_t i = 0; i < kShape; ++i)
            channels_[c].shape[i] = interpolated(kSkyShape, kShape, between, a, weights, c, i);
        channels_[c].radiance = interpolated(kSkyRadiance, 1, between, a, weights, c, 0);
        // A red sun has colours beyond Rec. 709.
        sun_[glm::length_t(c)] = std::max(sunAt(between, sunElevation, c) * kSunUnit, 0.0);
    }
}

/// Equation 8 of the paper of 2012.
glm::dvec3 SkyModel::sky(double cosine, double cosSun) const {
    cosSun = std::clamp(cosSun, -1.0, 1.0);
    const double fromSun = std::acos(cosSun), root = std::sqrt(cosine);
    glm::dvec3 result;
    for (size_t k = 0; k < kChannels; ++k) {
        const auto& [a, b, c, d, e, f, g, i, h] = channels_[k].shape;
        const double away = 1 + h * h - 2 * h * cosSun;
        const double chi = (1 + cosSun * cosSun) / (away * std::sqrt(away)); // about the sun
        const double horizon = 1 + a * std::exp(b / (cosine + 0.01));
        const double rest =
            c + d * std::exp(e * fromSun) + f * cosSun * cosSun + g * chi + i * root;
        result[glm::length_t(k)] = std::max(horizon * rest * channels_[k].radiance * kUnit, 0.0);
    }
    return result;
}

glm::dvec3 SkyModel::sun() const {
    return sun_;
}

double SkyModel::halfSun() {
    return glm::radians(0.5358 / 2);
}

} // namespace stromboli::sky
