#pragma once

#include "host/denoise/noisy_picture.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>

namespace stromboli::test {

/// What a pixel shows, without noise.
struct Truth {
    glm::vec3 radiance{1.0f}, albedo{0.5f}, normal{0.0f, 0.0f, 1.0f};
    float depth = 4;
    float sigma = 0; ///< of the error of the mean, times radiance
};
using TruthOf = std::function<Truth(uint32_t x, uint32_t y)>;

/// A picture with normal errors, which are independent in both halves of the samples, in all
/// channels and pixels.
denoise::NoisyPicture noisyPicture(uint32_t width, uint32_t height, const TruthOf& truth,
                                   uint32_t seed);

/// Mean over pixels and channels of the squared error, relative as in relMSE, of a picture.
double relMse(const std::vector<glm::vec3>& picture, uint32_t width, const TruthOf& truth);

/// A room as pictures have it: walls that meet in a corner, a textured floor, a shadow whose edge
/// no layer knows of, light that falls off.
Truth room(uint32_t x, uint32_t y, float sigma);

/// Numbers from 0 to 1 that do not repeat.
float mixed(uint32_t x, uint32_t y, uint32_t which);

} // namespace stromboli::test
