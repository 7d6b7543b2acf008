#include "host/render/noise_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

/// Half the width of the window whose pixels are judged together, less a half. 25 pixels of 16
/// samples: a relative sigma of 7 % for normal samples.
constexpr int64_t kReach = 2;

/// Sums over a window of a picture: variances of one sample and means.
struct WindowSums {
    glm::dvec3 variance{0.0}, mean{0.0};
    uint32_t pixels = 0;
};

WindowSums windowAround(const Film& film, int64_t x, int64_t y) {
    WindowSums sums;
    const int64_t top = std::max<int64_t>(y - kReach, 0);
    const int64_t bottom = std::min<int64_t>(y + kReach, int64_t(film.height) - 1);
    const int64_t left = std::max<int64_t>(x - kReach, 0);
    const int64_t right = std::min<int64_t>(x + kReach, int64_t(film.width) - 1);
    for (int64_t j = top; j <= bottom; ++j)
        for (int64_t i = left; i <= right; ++i) {
            const PixelStatistics& p = film.at(uint32_t(i), uint32_t(j));
            if (p.count < 2) continue; // outside the crop, or nothing but rejected samples
            sums.variance += p.variance();
            sums.mean += p.mean;
            ++sums.pixels;
        }
    return sums;
}

double meanOfChannels(const glm::dvec3& v) {
    return (v.x + v.y + v.z) / 3;
}

} // namespace

NoiseEstimate::NoiseEstimate(std::vector<uint32_t> pixels)
    : pixels_(std::move(pixels)), counts_(pixels_.size(), 0), means_(pixels_.size()),
      squaredErrors_(pixels_.size(), glm::dvec3(0.0)) {}

void NoiseEstimate::update(const Film& film) {
    for (size_t i = 0; i < pixels_.size(); ++i) {
        const PixelStatistics& p = film.pixels[pixels_[i]];
        if (p.count == counts_[i]) continue;
        const glm::dvec3 moved = p.mean - means_[i];
        squaredErrors_[i] = counts_[i] == 0
                                ? p.varianceOfMean()
                                : moved * moved * double(counts_[i]) / double(p.count - counts_[i]);
        counts_[i] = p.count;
        means_[i] = p.mean;
    }
}

double NoiseEstimate::meanRadiance(const Film& film) const {
    double sum = 0;
    for (uint32_t pixel : pixels_)
        sum += meanOfChannels(film.pixels[pixel].mean);
    return pixels_.empty() ? 0 : sum / double(pixels_.size());
}

double NoiseEstimate::picture(const Film& film) const {
    const double floor = kRelativeFloor * meanRadiance(film);
    if (floor == 0) return 0; // black
    double sum = 0;
    for (size_t i = 0; i < pixels_.size(); ++i) {
        const glm::dvec3 mean = film.pixels[pixels_[i]].mean;
        sum += meanOfChannels(squaredErrors_[i] / (mean * mean + floor * floor));
    }
    return std::sqrt(sum / double(pixels_.size()));
}

std::vector<double> NoiseEstimate::relativeVariance(const Film& film) const {
    const double floor = kRelativeFloor * meanRadiance(film);
    std::vector<double> result(film.pixels.size(), 0.0);
    if (floor == 0) return result;
    for (uint32_t pixel : pixels_) {
        const WindowSums sums = windowAround(film, pixel % film.width, pixel / film.width);
        if (sums.pixels == 0) continue;
        const glm::dvec3 mean = sums.mean / double(sums.pixels);
        const glm::dvec3 variance = sums.variance / double(sums.pixels);
        result[pixel] = meanOfChannels(variance / (mean * mean + floor * floor));
    }
    return result;
}

} // namespace stromboli
