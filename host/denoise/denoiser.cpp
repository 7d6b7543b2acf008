#include "host/denoise/denoiser.hpp"

#include "host/core/error.hpp"
#include "host/denoise/device_filter.hpp"
#include "host/denoise/half_blend.hpp"
#include "host/denoise/oidn.hpp"
#include "host/denoise/prepare.hpp"
#include "host/denoise/reference_filter.hpp"
#include "host/denoise/stated_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::denoise {
namespace {

/// The filter's results, wherever it runs.
std::vector<ReferenceResult> filter(const Prepared& picture, const vulkan::Device* device,
                                    const std::function<bool()>& isUnwanted) {
    if (!device) return filterOnHost(picture);
    std::vector<ReferenceResult> results;
    results.reserve(picture.pixels.size());
    for (const gpu::DenoiseResult& r : DeviceFilter(*device).run(picture, isUnwanted))
        results.push_back({r.mean, r.shares, glm::dvec2(r.ownNoise, r.ownChange),
                           glm::dvec2(r.windowNoise, r.windowChange), r.ownVariance});
    return results;
}

/// The noise that is left in a pixel by what its neighbours say, too: one pixel's is as rough as a
/// square of one number.
double noiseLeftAround(const std::vector<ReferenceResult>& filtered, uint32_t width,
                       uint32_t height, size_t pixel) {
    constexpr int kAround = 2;
    const int x = int(pixel % width), y = int(pixel / width);
    double sum = 0, pixels = 0;
    for (int v = std::max(y - kAround, 0); v <= std::min(y + kAround, int(height) - 1); ++v)
        for (int u = std::max(x - kAround, 0); u <= std::min(x + kAround, int(width) - 1); ++u)
            sum += filtered[size_t(v) * width + size_t(u)].ownVariance, ++pixels;
    return sum / pixels;
}

/// Standard errors that a pixel may change by.
constexpr double kMostErrors = 4;

/// What samples that have all met no light may have missed, squared, by channel. The pixels around
/// say how much light one sample brings: where it is met with a probability of p and then seen as
/// L, the mean is p L and the variance of the mean of n samples p L^2 / n, so that their quotient
/// is L / n, the standard error of a pixel that one sample has met. It is at most the standard
/// error of those around: where p is small none of them may have met any.
glm::dvec3 varianceOfNothing(const Prepared& prepared, uint32_t width, uint32_t height,
                             size_t pixel) {
    constexpr int kReach = 2;
    const int x = int(pixel % width), y = int(pixel / width);
    glm::dvec3 squares(0.0), means(0.0);
    double weights = 0;
    for (int v = std::max(y - kReach, 0); v <= std::min(y + kReach, int(height) - 1); ++v)
        for (int u = std::max(x - kReach, 0); u <= std::min(x + kReach, int(width) - 1); ++u) {
            const gpu::DenoisePixel& q = prepared.pixels[size_t(v) * width + size_t(u)];
            const glm::dvec3 deviation(q.deviation);
            squares += double(q.weight) * deviation * deviation;
            means += double(q.weight) * glm::dvec3(q.mean);
            weights += double(q.weight);
        }
    if (weights == 0) return squares;
    constexpr double kNotZero = std::numeric_limits<double>::min();
    const glm::dvec3 ofOneSample = squares / glm::max(means, kNotZero);
    return glm::min(squares / weights, ofOneSample * ofOneSample);
}

/// How much of its change a pixel makes: no more than its own samples can be wrong by, where their
/// variance is known; a deviation alone is one number. Where they agree that it is dark, the noise
/// of its neighbours says nothing of it.
double shareOfChange(const NoisyPicture& picture, const Prepared& prepared, size_t pixel,
                     const glm::dvec3& change) {
    const gpu::DenoisePixel& p = prepared.pixels[pixel];
    if (p.weight == 0 || picture.variance.empty()) return 1;
    const glm::dvec3 deviation(p.deviation), albedo(prepared.albedo[pixel]);
    const glm::dvec3 perScale = albedo / double(prepared.scale);
    glm::dvec3 variance = glm::max(deviation * deviation,
                                   glm::dvec3(picture.variance[pixel]) / (perScale * perScale));
    // Samples that have all met no light have no variance, and are not known for it.
    if (sumOf(variance) == 0 && sumOf(glm::dvec3(p.mean)) == 0)
        variance = varianceOfNothing(prepared, picture.width, picture.height, pixel);
    const double allowed = kMostErrors * sumOf(glm::sqrt(variance) * albedo);
    const double wanted = sumOf(glm::abs(change) * albedo);
    return wanted > allowed ? allowed / wanted : 1;
}

DenoisedPicture denoiseByFilter(const NoisyPicture& picture, const vulkan::Device* device,
                                const std::function<bool()>& isUnwanted) {
    Prepared prepared = prepare(picture);
    limitOutliers(prepared);
    const std::vector<ReferenceResult> filtered = filter(prepared, device, isUnwanted);
    if (filtered.empty()) return {};
    DenoisedPicture result{picture.width, picture.height};
    std::vector<PixelError> errors;
    errors.reserve(filtered.size());
    double noisyShares = 0;
    for (size_t i = 0; i < filtered.size(); ++i) {
        const ReferenceResult& f = filtered[i];
        const glm::dvec2 parts(picture.errorShare.empty() ? 1.0f : picture.errorShare[i], 1);
        const gpu::DenoisePixel& own = prepared.pixels[i];
        const glm::dvec3 albedo(prepared.albedo[i]), change = f.mean - glm::dvec3(own.mean);
        const double share = shareOfChange(picture, prepared, i, change);
        const glm::dvec3 mean = (glm::dvec3(own.mean) + share * change) * albedo;
        const glm::dvec3 compared = mean * mean + prepared.floor * prepared.floor;
        const double left = parts.x * noiseLeftAround(filtered, picture.width, picture.height, i);
        const double expected = std::max(glm::dot(parts, f.window), left);
        result.mean.emplace_back(mean / double(prepared.scale));
        result.error.emplace_back(glm::sqrt(expected * compared) / double(prepared.scale));
        // A part of the change has the square of that part, and what it takes of the error
        // is the part of what it took.
        const glm::dvec3 deviation = glm::dvec3(own.deviation) * albedo;
        const double before = own.weight * sumOf(deviation * deviation / compared) / 3;
        const glm::dvec2 error =
            share < 1 ? glm::dvec2(before + share * (f.own.x - before), share * share * f.own.y)
                      : f.own;
        errors.push_back({glm::dot(parts, error), parts.x * f.ownVariance});
        noisyShares += 1 - f.shares.x - f.shares.y - f.shares.z;
    }
    Summary& s = result.summary;
    s.noise = statedError(picture.width, picture.height, errors);
    s.noisyShare = filtered.empty() ? 0 : noisyShares / double(filtered.size());
    s.movedLight = prepared.movedLight;
    s.limitedPixels = prepared.limitedPixels;
    s.unknownPixels = picture.unknownPixels;
    s.hasLayers = !picture.albedo.empty() && !picture.normal.empty() && !picture.depth.empty();
    return result;
}

/// Gives back the light that the picture as a whole has lost, or takes what it has gained: weights
/// that look at radiance leave out neighbours that are bright by chance. A pixel has a part of it
/// as its radiance and what is predicted of its error allow, so that what is black or without noise
/// stays as it is.
void keepLight(const NoisyPicture& picture, DenoisedPicture& denoised) {
    double missing = 0, parts = 0;
    const auto partsOf = [&](size_t pixel) {
        constexpr double kNotZero = std::numeric_limits<double>::min();
        const glm::dvec3 mean = glm::max(glm::dvec3(denoised.mean[pixel]), 0.0);
        const glm::dvec3 error(denoised.error[pixel]);
        return mean * error / glm::max(mean + error, kNotZero);
    };
    for (size_t i = 0; i < denoised.mean.size(); ++i) {
        if (!std::isfinite(picture.mean[i].x)) continue; // NoisyPicture::unknownPixels
        missing += sumOf(glm::dvec3(picture.mean[i])) - sumOf(glm::dvec3(denoised.mean[i]));
        parts += sumOf(partsOf(i));
    }
    if (!(parts > 0)) return;
    const double share = std::max(missing / parts, -1.0);
    for (size_t i = 0; i < denoised.mean.size(); ++i)
        if (std::isfinite(picture.mean[i].x)) denoised.mean[i] += glm::vec3(share * partsOf(i));
}

DenoisedPicture denoiseByOidn(const NoisyPicture& picture) {
    const OidnHalves halves = runOidn(picture);
    DenoisedPicture result = blendHalves(picture, halves.first, halves.second);
    result.summary.hasLayers = !picture.albedo.empty() && !picture.normal.empty();
    return result;
}

} // namespace

void requireUsable(Denoiser which) {
    if (which == Denoiser::Oidn && !oidnMissing().empty()) throw UsageError(oidnMissing());
}

DenoisedPicture denoisePicture(const NoisyPicture& picture, Denoiser which,
                               const vulkan::Device* device,
                               const std::function<bool()>& isUnwanted) {
    DenoisedPicture denoised = which == Denoiser::Oidn
                                   ? denoiseByOidn(picture)
                                   : denoiseByFilter(picture, device, isUnwanted);
    keepLight(picture, denoised);
    return denoised;
}

const std::vector<std::string>& channelNames() {
    static const std::vector<std::string> names = {"error.R", "error.G", "error.B",
                                                   "noisy.R", "noisy.G", "noisy.B"};
    return names;
}

void addChannels(FloatImage& image, const NoisyPicture& noisy, const DenoisedPicture& denoised) {
    const std::vector<std::string>& names = channelNames();
    for (size_t c = 0; c < 3; ++c) {
        std::vector<float>& error = image.channel(names[c]);
        std::vector<float>& before = image.channel(names[c + 3]);
        for (size_t i = 0; i < denoised.mean.size(); ++i) {
            error[i] = denoised.error[i][int(c)];
            before[i] = noisy.mean[i][int(c)];
        }
    }
}

} // namespace stromboli::denoise
