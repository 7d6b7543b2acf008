#include "host/reference/camera_ray.hpp"

namespace stromboli::reference {

Ray cameraRay(const Camera& camera, double s, double t, const glm::dvec2& onLens) {
    const glm::dvec3 offset = ((2 * s - 1) * camera.halfWidth + camera.shift.x) * camera.right +
                              ((1 - 2 * t) * camera.halfHeight + camera.shift.y) * camera.up;
    Ray ray;
    if (camera.orthographic) {
        ray.origin = camera.position + offset;
        ray.direction = -camera.back;
    } else {
        ray.origin =
            camera.position + camera.lensRadius * (onLens.x * camera.right + onLens.y * camera.up);
        const glm::dvec3 sharp = camera.position + camera.focusDistance * (offset - camera.back);
        ray.direction = glm::normalize(sharp - ray.origin);
    }
    const double depthPerLength = camera.clipAlongRay ? 1 : -glm::dot(ray.direction, camera.back);
    ray.tMin = camera.nearDistance / depthPerLength;
    ray.tMax = camera.farDistance / depthPerLength;
    return ray;
}

} // namespace stromboli::reference
