#pragma once

#include "host/bvh/wide_layout.hpp"
#include "scene/camera/camera.hpp"

namespace stromboli {

/// The share of a picture, in [0, 1], where the camera sees a surface and not past all of them: of
/// a fixed grid of rays through the camera's position, within the distances that it clips to.
/// Surfaces that are partly not there count as there.
double shareOfSurfacesInView(const WideLayout& bvh, const Camera& camera);

} // namespace stromboli
