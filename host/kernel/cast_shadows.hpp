#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <optional>

namespace stromboli {

/// The shadow map of the brightest sun, a light from one direction, over where a picture takes
/// light samples: what opaque triangles shade, each by itself, so that a picture is the same with
/// and without. None where less than leastShare of the samples' places that face the sun would be
/// told to be in shadow, where there is no sun, and beside media. Not for light samples that go
/// through glass.
std::optional<ShadowMap> castShadows(const Scene& scene, const GpuScene& packed,
                                     const Camera& camera, double leastShare = 0);

/// This, where looking at it takes less time than the rays that are not traced.
std::optional<ShadowMap> shadowsThatPay(const Scene& scene, const GpuScene& packed,
                                        const Camera& camera);

/// Whether a place is in shadow for certain, as the kernel has it
/// (shaders/include/shadow_map.glsl).
bool isInShadow(const ShadowMap& map, const glm::vec3& origin, const glm::vec3& direction);

} // namespace stromboli
