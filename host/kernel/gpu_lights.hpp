#pragma once

#include "host/kernel/gpu_scene.hpp"

namespace stromboli {

/// Fills g.lights, g.emitterEntries and the light counts. placeOf[i] is the place of scene
/// triangle i in BVH order.
void packLights(const Scene& scene, const std::vector<uint32_t>& placeOf, bool cs184, GpuScene& g);

} // namespace stromboli
