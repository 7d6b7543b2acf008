#pragma once

#include "host/kernel/feelers.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

namespace stromboli {

/// The share of the light of lamps, or of the sky, whichever is more, that reaches what the camera
/// sees, and what is seen from there, through clear glass alone, in the direction of a light
/// sample; of lights that are sampled. Found by a few thousand rays, the same in every render; what
/// follows from it changes the noise of a picture and no more, so that it need not be exact. 0:
/// where no light is sampled, or there is no clear glass.
double shareThroughGlass(const Scene& scene, const GpuScene& packed, const Camera& camera);

/// Its clear glass. What it returns refers to `packed`.
SeesThrough clearGlassOf(const GpuScene& packed);

} // namespace stromboli
