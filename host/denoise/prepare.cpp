#include "host/denoise/prepare.hpp"

#include "host/render/picture_noise.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::denoise {
namespace {

/// The difference to that neighbour that is more like the pixel: at the rim of a surface one of
/// them belongs to another.
float slopeOf(const float* before, float here, const float* after) {
    const float left = before ? here - *before : 0, right = after ? *after - here : 0;
    if (!before) return right;
    if (!after) return left;
    return std::abs(left) < std::abs(right) ? left : right;
}

/// One over the depth: 0 where nothing is seen, and linear in the picture over a plane, however it
/// is turned away.
float disparityOf(float depth) {
    return std::isfinite(depth) && depth > 0 ? 1 / depth : 0.0f;
}

glm::vec3 finite(const glm::vec3& v) {
    return {std::isfinite(v.x) ? v.x : 0.0f, std::isfinite(v.y) ? v.y : 0.0f,
            std::isfinite(v.z) ? v.z : 0.0f};
}

void fillSlopes(Prepared& picture) {
    const uint32_t w = picture.width, h = picture.height;
    for (uint32_t y = 0; y < h; ++y)
        for (uint32_t x = 0; x < w; ++x) {
            gpu::DenoisePixel* const p = &picture.pixels[size_t(y) * w + x];
            p->slopeX = slopeOf(x > 0 ? &p[-1].disparity : nullptr, p->disparity,
                                x + 1 < w ? &p[1].disparity : nullptr);
            p->slopeY = slopeOf(y > 0 ? &(p - w)->disparity : nullptr, p->disparity,
                                y + 1 < h ? &(p + w)->disparity : nullptr);
        }
}

/// The mean over the pixels that are known.
double meanRadianceOf(const NoisyPicture& picture) {
    double sum = 0;
    uint64_t known = 0;
    for (const glm::vec3& mean : picture.mean)
        if (std::isfinite(mean.x)) sum += sumOf(mean) / 3, ++known;
    return known > 0 ? sum / double(known) : 0;
}

/// A power of two, so that nothing is rounded, and a normal float.
float scaleTo1(double mean) {
    if (!(mean > 0) || !std::isfinite(mean)) return 1;
    return std::ldexp(1.0f, std::clamp(-std::ilogb(mean), -120, 120));
}

} // namespace

Prepared prepare(const NoisyPicture& picture) {
    Prepared result{picture.width, picture.height};
    const double mean = meanRadianceOf(picture);
    result.scale = scaleTo1(mean);
    result.meanRadiance = mean * result.scale;
    result.pixels.resize(picture.pixelCount());
    result.albedo.resize(picture.pixelCount(), glm::vec3(1.0f));
    for (size_t i = 0; i < result.pixels.size(); ++i) {
        gpu::DenoisePixel& p = result.pixels[i];
        p = {};
        if (!picture.albedo.empty()) {
            p.albedo = finite(picture.albedo[i]);
            result.albedo[i] = glm::max(p.albedo, gpu::DENOISE_LEAST_ALBEDO);
        } else {
            p.albedo = glm::vec3(1.0f);
        }
        if (!picture.normal.empty()) p.normal = finite(picture.normal[i]);
        if (!picture.depth.empty()) p.disparity = disparityOf(picture.depth[i]);
        if (!std::isfinite(picture.mean[i].x)) continue; // NoisyPicture::unknownPixels
        p.weight = 1;
        p.mean = result.scale * picture.mean[i] / result.albedo[i];
        p.deviation = result.scale * picture.deviation[i] / result.albedo[i];
        // Where samples do not say how far apart they are, their halves do.
        const glm::vec3 spread =
            picture.variance.empty()
                ? p.deviation
                : result.scale * glm::sqrt(glm::max(picture.variance[i], 0.0f)) / result.albedo[i];
        p.variance = glm::dot(spread, spread);
    }
    // relMSE's; where all is black there is nothing to compare with.
    if (result.meanRadiance > 0) result.floor = kRelativeFloor * result.meanRadiance;
    fillSlopes(result);
    return result;
}

glm::dvec3 featureDifferences(const gpu::DenoisePixel& p, const gpu::DenoisePixel& q, double dx,
                              double dy) {
    const glm::dvec3 albedo = glm::dvec3(q.albedo) - glm::dvec3(p.albedo);
    const glm::dvec3 normal = glm::dvec3(q.normal) - glm::dvec3(p.normal);
    const double scale = double(std::max(p.disparity, q.disparity)) + 1e-30; // no 0 / 0
    const double depth =
        (double(q.disparity) - p.disparity - double(p.slopeX) * dx - double(p.slopeY) * dy) / scale;
    return {glm::dot(albedo, albedo), glm::dot(normal, normal), depth * depth};
}

} // namespace stromboli::denoise
