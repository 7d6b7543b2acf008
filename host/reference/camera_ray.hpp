#pragma once

#include "host/reference/intersect.hpp"
#include "scene/camera/camera.hpp"

namespace stromboli::reference {

/// The ray through picture coordinates s, t in [0, 1], from the left and from the top, limited to
/// the distances that the camera clips to. onLens: where it leaves from, on the unit disk.
Ray cameraRay(const Camera& camera, double s, double t, const glm::dvec2& onLens = glm::dvec2(0));

} // namespace stromboli::reference
