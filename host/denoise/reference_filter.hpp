#pragma once

#include "host/denoise/prepare.hpp"
#include "shaders/shared/denoise_types.h"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::denoise {

/// What the filter makes of a pixel (gpu::DenoiseResult).
struct ReferenceResult {
    glm::dvec3 mean{0.0};
    glm::dvec3 shares{0.0};
    glm::dvec2 own{0.0}, window{0.0}; ///< ownNoise and ownChange, windowNoise and windowChange
    double ownVariance = 0;
};

/// The filter in double precision, from its formulas (docs/theory/denoising.md): what the shaders
/// are compared with, and what denoises where the CPU reference renders.
std::vector<ReferenceResult> filterOnHost(const Prepared& picture);

} // namespace stromboli::denoise
