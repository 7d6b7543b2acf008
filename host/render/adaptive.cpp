#include "host/render/adaptive.hpp"

#include "host/core/color.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stromboli {
namespace {

/// 97.5 % quantile of the normal distribution: half width of a 95 % interval in sigmas.
constexpr double k95 = 1.96;

/// The CS184 rule: each channel's 95 % interval within tolerance times its mean. A pixel whose
/// samples are all black passes at once.
bool everyChannelIsDone(const PixelStatistics& p, double tolerance) {
    const glm::dvec3 variance = p.varianceOfMean();
    for (int c = 0; c < 3; ++c)
        if (k95 * std::sqrt(variance[c]) > tolerance * std::abs(p.mean[c])) return false;
    return true;
}

/// Statistics over a pixel and its neighbours, so that a pixel that has not met the light yet
/// is judged by those that have.
struct Neighbourhood {
    double mean = 0;     ///< luminance
    double variance = 0; ///< of one sample, luminance bound: channels fully correlated
};

/// Variance of the luminance, bounded above: sigma of a weighted sum is at most the weighted sum
/// of sigmas.
double luminanceVariance(const glm::dvec3& variance) {
    const double sigma = luminance(glm::sqrt(variance));
    return sigma * sigma;
}

} // namespace

std::vector<PixelTarget> SamplingPlan::next(const Film& film) const {
    return budget_.adaptive.enabled ? adaptive(film) : uniform(film);
}

std::vector<PixelTarget> SamplingPlan::uniform(const Film& film) const {
    uint32_t least = budget_.mostSamplesPerPixel;
    for (const PixelStatistics& p : film.pixels)
        least = std::min(least, p.taken());
    // The largest power of two below the end: what the last pass changes says how large the noise
    // is that is left (noise_estimate.hpp). A few samples, of which the variance says as much, are
    // not worth a pass more.
    const uint64_t lastButOne = budget_.mostSamplesPerPixel < kFirstPass
                                    ? 0
                                    : std::bit_floor(budget_.mostSamplesPerPixel - 1);
    const uint64_t usual = least == 0 ? kFirstPass : uint64_t(least) * 4;
    const auto samples =
        uint32_t(least < lastButOne ? std::min(usual, lastButOne) : budget_.mostSamplesPerPixel);
    std::vector<PixelTarget> pass;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel)
        if (film.pixels[pixel].taken() < samples) pass.push_back({pixel, samples});
    return pass;
}

std::vector<PixelTarget> SamplingPlan::adaptive(const Film& film) const {
    const bool perChannel = budget_.adaptive.rule == Adaptive::Rule::PerChannel;
    const std::vector<bool> wanted =
        perChannel ? unfinishedPerChannel(film) : unfinishedByNeighbourhood(film);
    std::vector<PixelTarget> pass;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const uint32_t taken = film.pixels[pixel].taken();
        if (!wanted[pixel] || taken >= budget_.mostSamplesPerPixel) continue;
        const uint32_t batch = budget_.adaptive.batch;
        const uint32_t first =
            perChannel ? batch : std::max(batch, kMinimumSamples); // before the first test
        const uint64_t target = taken == 0 ? first : uint64_t(taken) + batch;
        pass.push_back({pixel, uint32_t(std::min<uint64_t>(target, budget_.mostSamplesPerPixel))});
    }
    return pass;
}

std::vector<bool> SamplingPlan::unfinishedPerChannel(const Film& film) const {
    std::vector<bool> wanted(film.pixels.size(), false);
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const PixelStatistics& p = film.pixels[pixel];
        wanted[pixel] = p.taken() == 0 || !everyChannelIsDone(p, budget_.adaptive.tolerance);
    }
    return wanted;
}

double SamplingPlan::pictureMean(const Film& film) const {
    double sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += luminance(p.mean);
    return film.pixels.empty() ? 0 : sum / double(film.pixels.size());
}

std::vector<bool> SamplingPlan::unfinishedByNeighbourhood(const Film& film) const {
    const double floor = kFloor * pictureMean(film);
    const auto at = [&](int64_t x, int64_t y) -> const PixelStatistics* {
        if (x < 0 || y < 0 || x >= film.width || y >= film.height) return nullptr;
        const PixelStatistics& p = film.at(uint32_t(x), uint32_t(y));
        return p.taken() > 0 ? &p : nullptr;
    };
    const auto neighbourhood = [&](int64_t x, int64_t y) {
        Neighbourhood n;
        int count = 0;
        for (int64_t dy = -1; dy <= 1; ++dy)
            for (int64_t dx = -1; dx <= 1; ++dx)
                if (const PixelStatistics* p = at(x + dx, y + dy)) {
                    n.mean += luminance(p->mean);
                    n.variance += luminanceVariance(p->variance());
                    ++count;
                }
        if (count > 0) n.mean /= count, n.variance /= count;
        return n;
    };
    std::vector<bool> noisy(film.pixels.size(), false);
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const PixelStatistics& p = film.pixels[pixel];
        if (p.taken() == 0) {
            noisy[pixel] = true;
            continue;
        }
        const Neighbourhood n = neighbourhood(pixel % film.width, pixel / film.width);
        const double variance = std::max(luminanceVariance(p.variance()), n.variance);
        const double level = std::max(std::min(luminance(p.mean), n.mean), floor);
        const double error = k95 * std::sqrt(variance / std::max(p.count, 1u));
        noisy[pixel] = error > budget_.adaptive.tolerance * level;
    }
    return dilate(noisy, film);
}

/// A pixel goes on while one of its eight neighbours does.
std::vector<bool> SamplingPlan::dilate(const std::vector<bool>& noisy, const Film& film) const {
    std::vector<bool> wanted(noisy.size(), false);
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const int64_t x = pixel % film.width, y = pixel / film.width;
        for (int64_t ny = std::max<int64_t>(y - 1, 0);
             ny <= std::min<int64_t>(y + 1, film.height - 1); ++ny)
            for (int64_t nx = std::max<int64_t>(x - 1, 0);
                 nx <= std::min<int64_t>(x + 1, film.width - 1); ++nx)
                if (noisy[size_t(ny * film.width + nx)]) wanted[pixel] = true;
    }
    return wanted;
}

} // namespace stromboli
