#pragma once

#include "host/denoise/denoiser.hpp"

#include <glm/glm.hpp>

#include <span>

namespace stromboli::denoise {

/// Blends the noisy picture with what any denoiser has made of each half of its samples, so that
/// the error is least that both halves together predict (docs/theory/denoising.md, "The error of a
/// blend"). The denoiser must have seen one half at a time. Fills in the whole picture but for what
/// is said of outliers.
DenoisedPicture blendHalves(const NoisyPicture& picture, std::span<const glm::vec3> first,
                            std::span<const glm::vec3> second);

} // namespace stromboli::denoise
