#include "host/compare/flip.hpp"

#include "host/core/color.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::compare {
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

} // namespace stromboli::compare
