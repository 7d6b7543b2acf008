#include "host/render/noise_estimate.hpp"

#include "host/render/pixel_windows.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

double meanOfChannels(const glm::dvec3& v) {
    return (v.x + v.y + v.z) / 3;
}

} // namespace

void NoiseEstimate::update(const Film& film) {
    const size_t pixels = film.pixels.size();
    memory_.counts.resize(pixels, 0);
    memory_.means.resize(pixels, glm::dvec3(0.0));
    memory_.squaredErrors.resize(pixels, glm::dvec3(0.0));
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelStatistics& p = film.pixels[i];
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
    for (const PixelStatistics& p : film.pixels)
        sum += meanOfChannels(p.mean);
    return film.pixels.empty() ? 0 : sum / double(film.pixels.size());
}

PictureNoise NoiseEstimate::picture(const Film& film) const {
    return pictureNoise(film, memory_.squaredErrors);
}

std::vector<double> NoiseEstimate::relativeVariance(const Film& film) const {
    const double floor = kRelativeFloor * meanRadiance(film);
    std::vector<double> result(film.pixels.size(), 0.0);
    if (floor == 0) return result;
    std::vector<glm::dvec3> variances(film.pixels.size());
    for (size_t i = 0; i < variances.size(); ++i)
        variances[i] = memory_.squaredErrors[i] * double(memory_.counts[i]);
    constexpr uint32_t kBand = 64; // rows a thread takes at a time
    tbb::parallel_for(0u, (film.height + kBand - 1) / kBand, [&](uint32_t band) {
        PixelWindows windows(film, variances, band * kBand);
        for (uint32_t y = band * kBand; y < std::min((band + 1) * kBand, film.height); ++y) {
            const std::vector<PixelGroup> row = windows.of(y);
            for (uint32_t x = 0; x < film.width; ++x) {
                const PixelGroup group = row[x].pixels > 0 ? row[x] : windows.alone(x, y);
                if (group.pixels == 0) continue;
                const glm::dvec3 mean = group.mean / group.pixels;
                result[size_t(y) * film.width + x] =
                    meanOfChannels(group.value / group.pixels / (mean * mean + floor * floor));
            }
        }
    });
    return result;
}

} // namespace stromboli
