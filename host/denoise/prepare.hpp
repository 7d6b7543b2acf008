#pragma once

#include "host/denoise/noisy_picture.hpp"
#include "shaders/shared/denoise_types.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace stromboli::denoise {

/// A picture as the filter reads it: radiance over albedo, and what tells one surface from another.
struct Prepared {
    uint32_t width = 0, height = 0;
    std::vector<gpu::DenoisePixel> pixels;
    std::vector<glm::vec3> albedo; ///< that radiance was divided by
    /// Radiance is multiplied by this power of two, which makes its mean about 1: what a picture
    /// becomes does not depend on its unit.
    float scale = 1;
    double meanRadiance = 0;
    double floor = 1; ///< radiance, that is added, squared, to that which errors are compared with
    double movedLight = 0; ///< the share of all light that limitOutliers() has moved
    uint64_t limitedPixels = 0;
};

inline double sumOf(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

/// Divides by the albedo and finds the slopes of the depth. Without layers all is one surface.
Prepared prepare(const NoisyPicture& picture);

/// A pixel that rests on a single sample is limited to what its neighbours on the same surface and
/// their errors allow; what is above that is spread over these, the pixel itself included, so that
/// no light is lost.
///
/// It rests on one sample if most of its light is in one of its two halves, and nothing of what its
/// neighbours have in common explains it. The error of a pixel that takes light is at least the
/// light that it takes.
void limitOutliers(Prepared& picture);

/// Squared differences of two pixels, (dx, dy) apart: of albedo, of normals, and of depth relative
/// to what the plane of the first one has there. 0 for one surface.
glm::dvec3 featureDifferences(const gpu::DenoisePixel& p, const gpu::DenoisePixel& q, double dx,
                              double dy);

} // namespace stromboli::denoise
