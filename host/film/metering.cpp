#include "host/film/metering.hpp"

#include "host/core/color.hpp"
#include "host/film/white_balance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace stromboli {
namespace {

constexpr double kMiddleGrey = 0.18;
constexpr double kLeastStops = -100, kMostStops = 100;
/// What is so many stops below the bright parts of a picture is black in it: in 8 bits of sRGB,
/// 2^-12.7 of white is the least that is not.
constexpr double kBlackStops = 12;
/// The share of pixels that is left out at either end.
constexpr double kLeftOut = 0.05;

struct LitPixel {
    double stops; ///< logarithm of the luminance, base 2
    size_t place; ///< in the colours
};

std::vector<LitPixel> meteredPixels(std::span<const glm::vec3> colors) {
    std::vector<LitPixel> pixels;
    for (size_t i = 0; i < colors.size(); ++i) {
        const double light = luminance(colors[i]);
        if (light > 0 && std::isfinite(light)) pixels.push_back({std::log2(light), i});
    }
    if (pixels.empty()) return pixels;
    const auto isDarker = [](const LitPixel& a, const LitPixel& b) {
        return a.stops != b.stops ? a.stops < b.stops : a.place < b.place;
    };
    std::ranges::sort(pixels, isDarker);
    const double bright = pixels[size_t((1 - kLeftOut) * double(pixels.size() - 1))].stops;
    const auto lit = std::ranges::find_if(
        pixels, [&](const LitPixel& p) { return p.stops >= bright - kBlackStops; });
    pixels.erase(pixels.begin(), lit);
    const auto out = std::ptrdiff_t(kLeftOut * double(pixels.size()));
    pixels.erase(pixels.end() - out, pixels.end());
    pixels.erase(pixels.begin(), pixels.begin() + out);
    return pixels;
}

} // namespace

double meteredExposure(std::span<const glm::vec3> colors) {
    const std::vector<LitPixel> pixels = meteredPixels(colors);
    if (pixels.empty()) return 0;
    double sum = 0;
    for (const LitPixel& pixel : pixels)
        sum += pixel.stops;
    const double stops = std::log2(kMiddleGrey) - sum / double(pixels.size());
    return std::clamp(std::round(100 * stops) / 100, kLeastStops, kMostStops);
}

std::optional<double> meteredIlluminant(std::span<const glm::vec3> colors) {
    glm::dvec3 sum(0);
    for (const LitPixel& pixel : meteredPixels(colors)) {
        const glm::dvec3 color = glm::max(glm::dvec3(colors[pixel.place]), glm::dvec3(0));
        sum += color / (color.x + color.y + color.z);
    }
    if (sum == glm::dvec3(0)) return std::nullopt;
    return nearestTemperature(sum);
}

} // namespace stromboli
