#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/render_types.h"

#include <glm/glm.hpp>

#include <array>
#include <vector>

namespace stromboli {

/// The occluders of light samples in a picture: rectangles of walls, floors and ceilings that stop
/// many of them. Each lies within triangles that are opaque, so that what crosses it would meet one
/// of these in any case: a picture is the same with and without. Found by rays from what the camera
/// sees, and from what is seen from there, the same ones in every render. Empty where less than
/// leastShare of the light samples would be stopped, and beside instances and media. Not for light
/// samples that go through glass, which may bend them past an occluder.
Occluders findOccluders(const Scene& scene, const GpuScene& packed, const Camera& camera,
                        double leastShare = 0);

/// These, where the rays that are not traced would take longer than it takes to look at them, by
/// GpuScene::ofRay.
Occluders occludersThatPay(const Scene& scene, const GpuScene& packed, const Camera& camera);

/// As the kernel reads them (Frame::occluders); behind the last one rectangles that nothing
/// crosses.
std::array<glm::vec4, gpu::OCCLUDER_ROWS * gpu::MOST_OCCLUDERS>
occluderRows(const Occluders& occluders);

/// Frame::leastFall.
float leastFall(const Occluders& occluders);

} // namespace stromboli
