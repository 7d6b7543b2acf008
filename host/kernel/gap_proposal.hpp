#pragma once

#include "host/kernel/gpu_scene.hpp"

namespace stromboli {

/// Width of the gap that the gap proposal aims at: the space between a scene's only light, a
/// rectangle, and a diffuse surface close to it. What leaves the gap comes from few directions,
/// into which the kernel sends some bounces (shaders/include/gap_proposal.glsl; docs/estimator.md,
/// "Gaps"). In scene units; positive on the side that edgeA x edgeB points to, negative on the
/// other; 0: there is no gap.
float gapWidth(const GpuScene& scene);

} // namespace stromboli
