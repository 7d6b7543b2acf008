#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/light_guide.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <optional>
#include <vector>

namespace stromboli {

/// Whether there is something to learn of which light samples to the sky arrive: not where so much
/// of what the camera sees lies open to it that they arrive in any case, nor where the sky is seen
/// through glass alone and none does.
bool seesSkyInPart(const GpuScene& scene, const Camera& camera);

/// Light samples to the environment of `packed`, where surfaces are that the camera sees, and that
/// are seen from there: the same ones in every render. goThroughGlass: light samples do.
std::vector<LightNote> noteLightSamples(const Scene& scene, const GpuScene& packed,
                                        const Camera& camera, bool goThroughGlass);

/// What is learnt from these; none: it would not pay, or media scatter light, whose samples are not
/// noted.
std::optional<LightGuide> guideThatPays(const Scene& scene, const GpuScene& packed,
                                        const Camera& camera, bool goThroughGlass);

} // namespace stromboli
