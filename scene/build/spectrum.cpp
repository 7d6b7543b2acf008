#include "scene/build/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::build {
namespace {

constexpr int kShortest = 360, kLongest = 830; ///< nanometres, of the CIE curves

/// A bell with different widths on its two sides.
double bell(double wavelength, double middle, double left, double right) {
    const double t = (wavelength - middle) / (wavelength < middle ? left : right);
    return std::exp(-0.5 * t * t);
}

/// Wyman et al. 2013, table 1 and equation 4.
glm::dvec3 cieCurves(double l) {
    return {1.056 * bell(l, 599.8, 37.9, 31.0) + 0.362 * bell(l, 442.0, 16.0, 26.7) -
                0.065 * bell(l, 501.1, 20.4, 26.2),
            0.821 * bell(l, 568.8, 46.9, 40.5) + 0.286 * bell(l, 530.9, 16.3, 31.1),
            1.217 * bell(l, 437.0, 11.8, 36.0) + 0.681 * bell(l, 459.0, 26.0, 13.8)};
}

/// CIE standard illuminant D65 (ISO 11664-2), every 10 nanometres from 360.
double daylight(double wavelength) {
    static constexpr std::array kPower = {
        46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008,
        117.812, 114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
        100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268,
        80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856, 75.0870, 63.5927,
        46.4182, 66.8054, 63.3828, 64.3040, 59.4519, 51.9590, 57.4406, 60.3125};
    static_assert(kPower.size() == (kLongest - kShortest) / 10 + 1);
    const double at = std::clamp((wavelength - kShortest) / 10, 0.0, double(kPower.size() - 1));
    const auto below = std::min(size_t(at), kPower.size() - 2);
    return std::lerp(kPower[below], kPower[below + 1], at - double(below));
}

double valueAt(std::span<const std::pair<double, double>> samples, double wavelength) {
    if (wavelength < samples.front().first || wavelength > samples.back().first) return 0;
    const auto above = std::ranges::lower_bound(samples, wavelength, {},
                                                [](const auto& sample) { return sample.first; });
    if (above == samples.begin()) return above->second;
    const auto below = above - 1;
    return std::lerp(below->second, above->second,
                     (wavelength - below->first) / (above->first - below->first));
}

/// `white`: the XYZ of what is 1 at all wavelengths.
template <class Weight>
glm::dvec3 rgbOf(std::span<const std::pair<double, double>> samples, const glm::dvec3& white,
                 Weight weight) {
    glm::dvec3 sum(0.0), whole(0.0);
    for (double l = kShortest; l <= kLongest; l += 0.5) {
        const glm::dvec3 curves = cieCurves(l) * weight(l);
        sum += curves * valueAt(samples, l);
        whole += curves;
    }
    const glm::dvec3 xyz = white * sum / whole;
    // IEC 61966-2-1; columns.
    const glm::dmat3 rgbFromXyz(3.240479, -0.969256, 0.055648, -1.537150, 1.875991, -0.204043,
                                -0.498535, 0.041556, 1.057311);
    return rgbFromXyz * xyz;
}

} // namespace

glm::dvec3 rgbOfLight(std::span<const std::pair<double, double>> samples) {
    const glm::dvec3 rgb = rgbOf(samples, glm::dvec3(1), [](double) { return 1.0; });
    return glm::max(rgb, glm::dvec3(0)); // outside of what the primaries can mix
}

glm::dvec3 rgbOfReflectance(std::span<const std::pair<double, double>> samples) {
    const glm::dvec3 d65(0.950456, 1, 1.088754); // the white of Rec. 709
    return glm::clamp(rgbOf(samples, d65, daylight), glm::dvec3(0), glm::dvec3(1));
}

std::vector<std::pair<double, double>> blackbody(double temperature) {
    constexpr double kLight = 299792458, kPlanck = 6.62607015e-34, kBoltzmann = 1.380649e-23;
    std::vector<std::pair<double, double>> samples;
    for (double nanometres = kShortest; nanometres <= kLongest; nanometres += 5) {
        const double l = nanometres * 1e-9;
        const double perMetre = 2 * kPlanck * kLight * kLight / std::pow(l, 5) /
                                std::expm1(kPlanck * kLight / (l * kBoltzmann * temperature));
        samples.emplace_back(nanometres, perMetre * 1e-9);
    }
    return samples;
}

} // namespace stromboli::build
