#pragma once

#include "scene/camera/camera.hpp"

namespace stromboli {

/// Sets how far from the camera its lens is sharp, as the request says, in a picture of that size.
/// Cameras without a lens stay as they are. Where the picture shows nothing that is far away.
/// Throws SceneError if a focus is asked for and there is no lens, and if it is a pixel that shows
/// nothing.
void focusLens(Camera& camera, const Scene& scene, const CameraRequest& request,
               const PictureSize& picture);

/// The depth, along the view axis, of the first surface that a pinhole ray of the camera meets, for
/// each place in the picture (s, t in [0, 1], from the left and from the top); infinite where there
/// is none. Rays pass what is hidden from the camera, has no material, or is less than half there.
std::vector<double> depthsSeen(const Camera& camera, const Scene& scene,
                               const std::vector<glm::dvec2>& places);

} // namespace stromboli
