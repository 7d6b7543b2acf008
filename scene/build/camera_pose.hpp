#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

namespace stromboli::build {

/// Sets position and axes of a camera that looks along the -z axis of the matrix, its y axis up; a
/// scaled or mirrored matrix still gives an orthonormal, right-handed pose. False if an axis of the
/// matrix has no length, or one that is not finite, or if y and z are one line.
bool poseCamera(FileCamera& camera, const glm::dmat4& toWorld);

/// Multiplies the camera's lengths by those of its node's axes: an orthographic view's extents by
/// x and y, the depth range by z.
void scaleCamera(FileCamera& camera, const glm::dvec3& scale);

} // namespace stromboli::build
