#pragma once

#include "host/kernel/gpu_scene.hpp"

namespace stromboli {

/// Width of the gap between a scene's only light, a rectangle, and a surface that it lights
/// diffusely from close by: what leaves the gap comes from few directions, into which the kernel
/// sends some bounces (shaders/include/gap_proposal.glsl; docs/estimator.md, "Gaps"). Scene units;
/// positive on the side that edgeA x edgeB points to, negative on the other; 0: there is none.
float gapWidth(const GpuScene& scene);

} // namespace stromboli
