#pragma once

#include "host/kernel/rows.hpp"
#include "scene/model/environment.hpp"
#include "shaders/shared/light_types.h"

#include <vector>

namespace stromboli {

/// An environment in the arrays that the kernel reads.
struct EnvironmentTable {
    std::vector<Row> texels; ///< EnvironmentTexel rows
    gpu::EnvironmentLight light{};
    double luminance = 0; ///< integral over all directions, of the radiance times the strength
};

EnvironmentTable packEnvironment(const Environment& environment);

/// Radiance as an EnvironmentTexel holds it, in `low` and `high`: to 2^-18 of its largest
/// component. Components are finite and not negative; those below 2^-127 may become 0.
void encodeRadiance(const glm::vec3& radiance, gpu::EnvironmentTexel& texel);
/// The radiance that the kernel reads.
glm::vec3 decodeRadiance(const gpu::EnvironmentTexel& texel);

} // namespace stromboli
