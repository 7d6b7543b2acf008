#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/weighed_lights.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <vector>

namespace stromboli {

/// How lights with LightTable::weighed are best picked: as packLights() has it where little is
/// gained; else each light as often as pays by how much of its light arrives where the camera sees
/// something, and at what is seen from there, and by what its samples cost, of which those through
/// glass take the longest. By an alias table some take none, in place of lights that are hidden. A
/// tenth of the samples stay with what packLights() has. Found by a few thousand rays, the same in
/// every render; the factors are rounded to quarters of a power of two, so that another rounding of
/// these rays hardly ever changes a picture. goThroughGlass: light samples do.
HowLightsArePicked howToPick(const Scene& scene, const GpuScene& packed, const Camera& camera,
                             bool goThroughGlass);

} // namespace stromboli
