#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace stromboli {

/// Makes camera rays for one picture. The picture plane is at distance 1 (perspective) or 0
/// (orthographic) in front of `position`. For picture coordinates s, t in [0, 1], from the left
/// and from the top:
///   offset = ((2 s - 1) halfWidth + shift.x) right + ((1 - 2 t) halfHeight + shift.y) up
/// - perspective:  origin = position,          direction = normalize(offset - back)
/// - orthographic: origin = position + offset, direction = -back
struct Camera {
    bool orthographic = false;
    glm::dvec3 position{0.0};
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1}; ///< orthonormal, right-handed
    double halfWidth = 1; ///< perspective: tangent of half the field of view; orthographic: length
    double halfHeight = 1;
    /// Where the middle of the picture lies beside the view axis; perspective cameras alone.
    glm::dvec2 shift{0.0};
    /// Hits count from nearDistance to farDistance: measured along the view axis, or, if
    /// clipAlongRay, along the ray.
    double nearDistance = 0, farDistance = 1e30;
    bool clipAlongRay = false;
    /// A thin lens (perspective cameras): rays begin anywhere on a disk of this radius about
    /// `position`, and those of one place in the picture meet at focusDistance along the view axis.
    /// 0: a pinhole.
    double lensRadius = 0;
    double focusDistance = 1;    ///< > 0
    uint32_t medium = kNoMedium; ///< where rays begin: into Scene::media

    /// From the middle of the picture, on its plane, to the position; perspective cameras.
    glm::dvec3 backOfMiddle() const { return back - shift.x * right - shift.y * up; }
};

/// Sees `at` from `from`; halfWidth: the tangent of half the angle of view, or half the width of an
/// orthographic picture.
Camera lookingAt(const glm::dvec3& from, const glm::dvec3& at, double halfWidth);

enum class CameraChoice {
    Automatic, ///< the file's camera; a CGL-dialect file, or one without a camera, is framed
    File,      ///< the file's camera
    Frame,     ///< all of the scene
};

/// What a lens makes sharp.
struct Focus {
    enum class On {
        Distance, ///< a plane across the view axis
        Middle,   ///< the plane of what is in the middle of the picture
        Pixel     ///< the plane of what a pixel shows
    } on = On::Distance;
    double distance = 1;   ///< of the plane, along the view axis, metres; greater than 0
    glm::dvec2 pixel{0.0}; ///< its column and row, from 0 at the left and at the top

    Focus(double metres = 1) : distance(metres) {}
    static Focus onMiddle();
    static Focus onPixel(const glm::dvec2& pixel);
};

/// Whose view a picture shows.
struct CameraRequest {
    CameraChoice choice = CameraChoice::Automatic;
    /// The file's camera of this name, or of this number, from 1; empty: the conventions say which.
    std::string name;
    std::optional<size_t> place; ///< in Scene::cameras, in place of its name
    /// In place of all of these: a perspective view from this point.
    std::optional<glm::dvec3> from;
    std::optional<glm::dvec3> at; ///< with `from`: what it looks at; empty: the scene's middle
    /// Radians, over the height of the picture: in place of the angle that the camera has.
    std::optional<double> fieldOfView;
    double aperture = 0; ///< diameter of the lens, metres; 0: a pinhole
    /// Where this lens, or the camera's own, is sharp; empty: the middle, or what the camera says.
    std::optional<Focus> focus;
    /// Radians, by which the camera is turned about the vertical axis through the scene's middle,
    /// counter-clockwise seen from above.
    double turn = 0;
    /// The picture is one of several, turned by different angles, that show the scene alike: a view
    /// that frames it leaves room for all of them.
    bool isOneOfTurns = false;

    CameraRequest(CameraChoice which = CameraChoice::Automatic, std::string ofName = {})
        : choice(which), name(std::move(ofName)) {}
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
    bool lastOfSeveral = false; ///< the last of a file's cameras counts; otherwise the first
    /// From where a framed view looks at a scene whose file has no camera: from before its front,
    /// which is +z in glTF, a little from the right and from above.
    glm::dvec3 directionWithoutCamera{0.45, 0.35, 1};
    /// Such a view is as close as shows all of the scene, in the middle, with a margin.
    bool fillsPicture = true;
    /// The depth range of the file's camera holds for framed views as well.
    bool clipsFramedViews = false;
    bool clipsAlongRay = false; ///< Camera::clipAlongRay
};

/// The place in Scene::cameras of the one that is meant; nothing if the file has none. Throws
/// SceneError, with the names that there are, if it has none of the name asked for.
std::optional<size_t> chosenCamera(const Scene& scene, const CameraRequest& request,
                                   const FramingConventions& conventions = {});

/// True if the view is one that frames the scene, and not that of the file's camera.
bool isFramed(const Scene& scene, const CameraRequest& request,
              const FramingConventions& conventions = {});

/// What the file asks for (RenderHints) for its own camera, or else 800 pixels wide in the file
/// camera's aspect ratio if it states one; 800 x 600 otherwise.
PictureSize defaultPictureSize(const Scene& scene, const CameraRequest& request,
                               const FramingConventions& conventions = {});

/// The camera for a picture of width x height pixels.
/// File: the whole of the file's field of view is visible; where the picture's shape differs,
/// it shows more on the longer side.
/// Frame: as close as shows all of a scene without a camera; else 1.5 diagonals of its box away, in
/// the direction in which FileCamera::pointAhead lies from the origin.
/// Throws SceneError if the file's camera is wanted and there is none, or none of that name, if
/// an orthographic camera is to have an angle of view or a lens, and if a focus is asked for where
/// there is no lens, or of a pixel that shows nothing.
Camera makeCamera(const Scene& scene, const CameraRequest& request, uint32_t width, uint32_t height,
                  const FramingConventions& conventions = {});

/// False if it is certain that the camera sees nothing of the scene's geometry: all of it is beside
/// the field of view or outside of the depth range. What hides behind something else counts as
/// seen.
bool mayShow(const Camera& camera, const Scene& scene);

} // namespace stromboli
