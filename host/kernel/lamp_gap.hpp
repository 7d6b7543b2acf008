#pragma once

#include "host/kernel/gpu_scene.hpp"

namespace stromboli {

/// Width of the gap between a scene's only lamp, a rectangle, and a diffuse surface that it lights
/// from close by: light that leaves the gap comes from few directions, into which the kernel sends
/// some bounces (docs/estimator.md, "Gaps"). Scene units; positive on the side that edgeA x edgeB
/// points to, negative on the other; 0: there is none.
float lampGap(const GpuScene& scene);

} // namespace stromboli
