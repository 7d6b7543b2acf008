#include "scene/build/camera_pose.hpp"

#include "scene/build/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::build {

bool poseCamera(FileCamera& camera, const glm::dmat4& toWorld) {
    const glm::dvec3 scale = axisLengths(toWorld);
    const double smallest = std::min({scale.x, scale.y, scale.z});
    const double largest = std::max({scale.x, scale.y, scale.z});
    if (!(smallest > 0) || !std::isfinite(largest)) return false;
    const glm::dvec3 y = toWorld[1], z = toWorld[2];
    camera.back = glm::normalize(z);
    const glm::dvec3 right = glm::cross(y, camera.back);
    if (!(glm::length(right) > 0)) return false;
    camera.position = toWorld[3];
    camera.right = glm::normalize(right);
    camera.up = glm::cross(camera.back, camera.right);
    camera.pointAhead = camera.position - z;
    return true;
}

void scaleCamera(FileCamera& camera, const glm::dvec3& scale) {
    if (camera.projection == Projection::Orthographic) {
        if (camera.halfWidth) *camera.halfWidth *= scale.x;
        if (camera.halfHeight) *camera.halfHeight *= scale.y;
    }
    camera.nearDistance *= scale.z;
    camera.farDistance *= scale.z;
}

} // namespace stromboli::build
