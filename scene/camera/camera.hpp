#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>

namespace stromboli {

/// Makes camera rays for one picture. The picture plane is at distance 1 (perspective) or 0
/// (orthographic) in front of `position`. For picture coordinates s, t in [0, 1], from the left
/// and from the top:
///   offset = (2 s - 1) halfWidth right + (1 - 2 t) halfHeight up
/// - perspective:  origin = position,          direction = normalize(offset - back)
/// - orthographic: origin = position + offset, direction = -back
struct Camera {
    bool orthographic = false;
    glm::dvec3 position{0.0};
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1}; ///< orthonormal, right-handed
    double halfWidth = 1; ///< perspective: tangent of half the field of view; orthographic: length
    double halfHeight = 1;
    /// Hits count from nearDistance to farDistance: measured along the view axis, or, if
    /// clipAlongRay, along the ray.
    double nearDistance = 0, farDistance = 1e30;
    bool clipAlongRay = false;
};

/// Sees `at` from `from`; halfWidth: the tangent of half the angle of view, or half the width of an
/// orthographic picture.
Camera lookingAt(const glm::dvec3& from, const glm::dvec3& at, double halfWidth);

enum class CameraChoice {
    Automatic, ///< the file's camera; a CGL-dialect file, or one without a camera, is framed
    File,      ///< the file's camera
    Frame,     ///< all of the scene (docs/cs184.md)
};

/// Size a picture gets when the user names none.
struct PictureSize {
    uint32_t width = 800, height = 600;
};

/// What belongs to a picture of a scene, where renderers differ.
struct FramingConventions {
    /// The size of a picture where none is named, to which framed views belong: a framed picture
    /// of another size is a crop of it or adds a margin to it, and the angle of a pixel stays.
    /// Empty: the file's camera states the picture's shape, and the framed view is scaled to it.
    std::optional<PictureSize> pictureSize;
    /// CameraChoice::Automatic frames every scene.
    bool framesEveryScene = false;
    bool clipsAlongRay = false; ///< Camera::clipAlongRay
};

/// Those of the CS184 renderer (docs/cs184.md).
FramingConventions cs184Framing();

/// 800 pixels wide in the file camera's aspect ratio if it states one; 800 x 600 otherwise.
PictureSize defaultPictureSize(const Scene& scene, CameraChoice choice,
                               const FramingConventions& conventions = {});

/// The camera for a picture of width x height pixels.
/// File: the whole of the file's field of view is visible; where the picture's shape differs,
/// it shows more on the longer side.
/// Frame: docs/cs184.md.
/// Throws SceneError if `choice` is File and the file has no camera.
Camera makeCamera(const Scene& scene, CameraChoice choice, uint32_t width, uint32_t height,
                  const FramingConventions& conventions = {});

} // namespace stromboli
