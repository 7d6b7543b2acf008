#include "host/render/noise_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

/// Half the width of the window of neighbours, less a half. 48 pixels of 4 samples: a relative
/// sigma of 12 % for normal samples. Neighbours that have more samples for a pixel's sake judge
/// that pixel in turn, the more so the fewer they are: 2, for all its 8 % less error, darkens
/// cornell_mirror_glass by 0.15 % (64 samples), 3 by 0.03 %.
constexpr int64_t kReach = 3;

/// By pixel of the film: the squared error times the samples it is of.
using Variances = std::vector<glm::dvec3>;

/// Sums over some pixels: variances of one sample and means.
struct Sums {
    glm::dvec3 variance{0.0}, mean{0.0};
    double pixels = 0;

    void operator+=(const Sums& other) {
        variance += other.variance;
        mean += other.mean;
        pixels += other.pixels;
    }
};

Sums sumsOf(const Film& film, const Variances& variances, size_t pixel) {
    const PixelStatistics& p = film.pixels[pixel];
    if (p.count < 2) return {}; // outside the crop, or nothing but rejected samples
    return {variances[pixel], p.mean, 1};
}

/// Sums over the neighbours of pixels, row after row from `first` on: the rows a window touches are
/// kept as sums over its width.
class Neighbours {
  public:
    Neighbours(const Film& film, const Variances& variances, int64_t first)
        : film_(film), variances_(variances) {
        rows_.assign(2 * kReach + 1, std::vector<Sums>(film.width));
        for (int64_t y = std::max<int64_t>(first - kReach, 0); y < first + kReach; ++y)
            sumRow(y);
    }

    /// Of the pixels of row y, the one after the last that was asked for.
    std::vector<Sums> of(int64_t y) {
        sumRow(y + kReach);
        std::vector<Sums> sums = besides(y);
        for (int64_t j = y - kReach; j <= y + kReach; ++j)
            for (size_t x = 0; j >= 0 && j != y && x < sums.size(); ++x)
                sums[x] += rows_[size_t(j) % rows_.size()][x];
        return sums;
    }

  private:
    Sums ownSums(int64_t x, int64_t y) const {
        return sumsOf(film_, variances_, size_t(y) * film_.width + size_t(x));
    }

    /// Neighbours in the same row.
    std::vector<Sums> besides(int64_t y) const {
        std::vector<Sums> sums(film_.width);
        for (int64_t x = 0; x < int64_t(film_.width); ++x) {
            const int64_t right = std::min<int64_t>(x + kReach, int64_t(film_.width) - 1);
            for (int64_t i = std::max<int64_t>(x - kReach, 0); i <= right; ++i)
                if (i != x) sums[size_t(x)] += ownSums(i, y);
        }
        return sums;
    }

    void sumRow(int64_t y) {
        std::vector<Sums>& row = rows_[size_t(y) % rows_.size()];
        std::fill(row.begin(), row.end(), Sums{});
        if (y >= int64_t(film_.height)) return;
        for (int64_t x = 0; x < int64_t(film_.width); ++x) {
            const Sums own = ownSums(x, y);
            const int64_t right = std::min<int64_t>(x + kReach, int64_t(film_.width) - 1);
            for (int64_t i = std::max<int64_t>(x - kReach, 0); i <= right; ++i)
                row[size_t(i)] += own;
        }
    }

    const Film& film_;
    const Variances& variances_;
    std::vector<std::vector<Sums>> rows_; ///< of rows y, at y modulo their number
};

double meanOfChannels(const glm::dvec3& v) {
    return (v.x + v.y + v.z) / 3;
}

} // namespace

NoiseEstimate::NoiseEstimate(std::vector<uint32_t> pixels)
    : pixels_(std::move(pixels)), memory_{
                                      std::vector<uint32_t>(pixels_.size(), 0),
                                      std::vector<glm::dvec3>(pixels_.size()),
                                      std::vector<glm::dvec3>(pixels_.size(), glm::dvec3(0.0))} {}

void NoiseEstimate::update(const Film& film) {
    for (size_t i = 0; i < pixels_.size(); ++i) {
        const PixelStatistics& p = film.pixels[pixels_[i]];
        if (p.count == memory_.counts[i]) continue;
        const glm::dvec3 moved = p.mean - memory_.means[i];
        memory_.squaredErrors[i] =
            memory_.counts[i] == 0
                ? p.varianceOfMean()
                : moved * moved * double(memory_.counts[i]) / double(p.count - memory_.counts[i]);
        memory_.counts[i] = p.count;
        memory_.means[i] = p.mean;
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
        sum += meanOfChannels(memory_.squaredErrors[i] / (mean * mean + floor * floor));
    }
    return std::sqrt(sum / double(pixels_.size()));
}

std::vector<double> NoiseEstimate::relativeVariance(const Film& film) const {
    const double floor = kRelativeFloor * meanRadiance(film);
    std::vector<double> result(film.pixels.size(), 0.0);
    if (floor == 0) return result;
    if (pixels_.empty()) return result;
    const auto [least, most] = std::ranges::minmax(pixels_); // a crop's rows are not the picture's
    const uint32_t first = least / film.width, last = most / film.width;
    Variances variances(film.pixels.size(), glm::dvec3(0.0));
    for (size_t i = 0; i < pixels_.size(); ++i)
        variances[pixels_[i]] = memory_.squaredErrors[i] * double(memory_.counts[i]);
    Neighbours neighbours(film, variances, first);
    for (uint32_t y = first; y <= last; ++y) {
        std::vector<Sums> row = neighbours.of(y);
        for (uint32_t x = 0; x < film.width; ++x) {
            if (row[x].pixels == 0) // alone
                row[x] = sumsOf(film, variances, size_t(y) * film.width + x);
            if (row[x].pixels == 0) continue;
            const glm::dvec3 mean = row[x].mean / row[x].pixels;
            const glm::dvec3 variance = row[x].variance / row[x].pixels;
            result[size_t(y) * film.width + x] =
                meanOfChannels(variance / (mean * mean + floor * floor));
        }
    }
    return result;
}

} // namespace stromboli
