#include "host/denoise/gap_filling.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace stromboli::denoise {
namespace {

/// Pixels to each side of those that are compared: 81, each with three channels that mostly go
/// together, know the ratio to some 15 %, and b to 0.05.
constexpr int kAround = 4;
constexpr double kFastest = 3; ///< of smooth integrands under scrambled nets (Owen 1997)

struct Sums {
    double differences = 0, variances = 0;

    void operator+=(const Sums& other) {
        differences += other.differences, variances += other.variances;
    }
};

double sumOfChannels(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

/// Over columns [x - kAround, x + kAround] of a row; the rows of a window are added to these.
std::vector<Sums> overWidth(const Film& film, std::span<const glm::dvec3> squaredErrors,
                            uint32_t y) {
    std::vector<Sums> row(film.width);
    for (int x = 0; x < int(film.width); ++x)
        for (int u = std::max(x - kAround, 0); u <= std::min(x + kAround, int(film.width) - 1);
             ++u) {
            const size_t i = size_t(y) * film.width + size_t(u);
            const PixelStatistics& p = film.pixels[i];
            if (p.count < 2) continue;
            row[size_t(x)] += {sumOfChannels(squaredErrors[i]), sumOfChannels(p.varianceOfMean())};
        }
    return row;
}

} // namespace

double shareOfError(double ratio, double samplesInHalf) {
    double slow = 1, fast = kFastest;
    for (int halvings = 0; halvings < 40; ++halvings) {
        const double b = 0.5 * (slow + fast);
        // Falls with b where a half has two samples and more.
        const bool isTooSlow = 2 * std::pow(samplesInHalf, 1 - b) * (1 - std::exp2(-b)) > ratio;
        (isTooSlow ? slow : fast) = b;
    }
    return 1 / (std::exp2(0.5 * (slow + fast)) - 1);
}

std::vector<float> sharesOfErrors(const Film& film, std::span<const glm::dvec3> squaredErrors) {
    std::vector<std::vector<Sums>> rows(film.height);
    tbb::parallel_for(0u, film.height,
                      [&](uint32_t y) { rows[y] = overWidth(film, squaredErrors, y); });
    std::vector<float> shares(film.pixels.size(), 1.0f);
    tbb::parallel_for(0, int(film.height), [&](int y) {
        for (uint32_t x = 0; x < film.width; ++x) {
            Sums window;
            for (int v = std::max(y - kAround, 0); v <= std::min(y + kAround, int(film.height) - 1);
                 ++v)
                window += rows[size_t(v)][x];
            const uint32_t count = film.at(x, uint32_t(y)).count;
            if (window.variances > 0 && count >= 4)
                shares[size_t(y) * film.width + x] =
                    float(shareOfError(window.differences / window.variances, 0.5 * count));
        }
    });
    return shares;
}

} // namespace stromboli::denoise
