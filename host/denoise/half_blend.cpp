#include "host/denoise/half_blend.hpp"

#include "host/denoise/stated_error.hpp"
#include "shaders/shared/denoise_types.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace stromboli::denoise {
namespace {

constexpr int kWindow = gpu::DENOISE_WINDOW_REACH;

/// Relative to the radiance: the error, what the change takes of it, the squared change.
struct Moments {
    double error = 0, taken = 0, product = 0, pixels = 0;
    double removed = 0; ///< the squared deviation that a whole share removes

    void operator+=(const Moments& other) {
        error += other.error, taken += other.taken;
        product += other.product, pixels += other.pixels, removed += other.removed;
    }
    void operator-=(const Moments& other) {
        error -= other.error, taken -= other.taken;
        product -= other.product, pixels -= other.pixels, removed -= other.removed;
    }
    /// The noise that is left with this share.
    double left(double share) const { return error - 2 * share * taken + share * share * removed; }
    /// known: how much of the squared deviation is error.
    double errorWith(double share, double known) const {
        return known * (error - 2 * share * taken) + share * share * product;
    }
    double bestShare() const {
        const double ridged =
            (1 + double(gpu::DENOISE_RIDGE)) * std::max(product, 0.0) + 1e-30; // no 0 / 0
        return std::clamp(taken / ridged, 0.0, 1.0);
    }
};

double meanOf(const glm::dvec3& v) {
    return (v.x + v.y + v.z) / 3;
}

double meanRadiance(const NoisyPicture& picture) {
    double sum = 0, known = 0;
    for (const glm::vec3& mean : picture.mean)
        if (std::isfinite(mean.x)) sum += meanOf(mean), ++known;
    return known > 0 ? sum / known : 0;
}

Moments momentsOf(const glm::dvec3& mean, const glm::dvec3& deviation, const glm::dvec3& first,
                  const glm::dvec3& second, double floor) {
    const glm::dvec3 even = 0.5 * (first + second), odd = 0.5 * (first - second);
    const glm::dvec3 counts = 1.0 / (even * even + floor * floor);
    const glm::dvec3 change = even - mean;
    return {meanOf(counts * deviation * deviation), meanOf(counts * deviation * (deviation - odd)),
            meanOf(counts * change * change), 1,
            meanOf(counts * (deviation - odd) * (deviation - odd))};
}

/// Sums over windows, by width and then by height, without the pixel in the middle, whose own error
/// has no say in its share.
std::vector<Moments> overWindows(const std::vector<Moments>& moments, int width, int height) {
    std::vector<Moments> rows(moments.size()), sums(moments.size());
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x)
            for (int u = std::max(x - kWindow, 0); u <= std::min(x + kWindow, width - 1); ++u)
                rows[size_t(y) * size_t(width) + size_t(x)] +=
                    moments[size_t(y) * size_t(width) + size_t(u)];
    });
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x)
            for (int v = std::max(y - kWindow, 0); v <= std::min(y + kWindow, height - 1); ++v)
                sums[size_t(y) * size_t(width) + size_t(x)] +=
                    rows[size_t(v) * size_t(width) + size_t(x)];
    });
    for (size_t i = 0; i < sums.size(); ++i)
        sums[i] -= moments[i];
    return sums;
}

} // namespace

DenoisedPicture blendHalves(const NoisyPicture& picture, std::span<const glm::vec3> first,
                            std::span<const glm::vec3> second) {
    const double floor = kRelativeFloor * meanRadiance(picture);
    std::vector<Moments> moments(picture.mean.size());
    for (size_t i = 0; i < moments.size(); ++i)
        if (std::isfinite(picture.mean[i].x) && floor > 0)
            moments[i] =
                momentsOf(picture.mean[i], picture.deviation[i], first[i], second[i], floor);
    const std::vector<Moments> windows =
        overWindows(moments, int(picture.width), int(picture.height));
    DenoisedPicture result{picture.width, picture.height};
    std::vector<PixelError> errors(moments.size());
    double noisyShares = 0;
    for (size_t i = 0; i < moments.size(); ++i) {
        const double known = picture.errorShare.empty() ? 1.0 : double(picture.errorShare[i]);
        const double share = windows[i].bestShare();
        const glm::dvec3 even = 0.5 * (glm::dvec3(first[i]) + glm::dvec3(second[i]));
        const glm::dvec3 mean =
            moments[i].pixels > 0 ? glm::mix(glm::dvec3(picture.mean[i]), even, share) : even;
        const double relative =
            std::max(windows[i].errorWith(share, known), 0.0) / std::max(windows[i].pixels, 1.0);
        result.mean.emplace_back(mean);
        result.error.emplace_back(glm::sqrt(relative * (mean * mean + floor * floor)));
        errors[i] = {moments[i].errorWith(share, known), known * moments[i].left(share)};
        noisyShares += 1 - share;
    }
    Summary& s = result.summary;
    s.noise = statedError(picture.width, picture.height, errors);
    s.noisyShare = moments.empty() ? 0 : noisyShares / double(moments.size());
    s.unknownPixels = picture.unknownPixels;
    return result;
}

} // namespace stromboli::denoise
