#include "scene/camera/camera.hpp"

#include "host/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace stromboli {
namespace {

/// Tangents of half the fields of view (orthographic: half sizes) a file asks for.
struct Frustum {
    double x = 0, y = 0;
};

constexpr double kDegree = std::numbers::pi / 180;
// The fields of view of a camera that states none.
constexpr double kDefaultX = 50 * kDegree, kDefaultY = 35 * kDegree;

double aspectOf(const PictureSize& size) {
    return double(size.width) / double(size.height);
}

Frustum defaultFrustum() {
    return {std::tan(kDefaultX / 2), std::tan(kDefaultY / 2)};
}

/// What the file states; the picture's own shape gives the extent that it leaves open.
Frustum fileFrustum(const FileCamera& camera, double pictureAspect) {
    const std::optional<double>&x = camera.halfWidth, &y = camera.halfHeight;
    if (x && y) return {*x, *y};
    if (x) return {*x, *x / pictureAspect};
    if (y) return {*y * pictureAspect, *y};
    return defaultFrustum();
}

/// Widens the frustum to the picture's shape so that nothing of it is lost.
Frustum widen(Frustum f, double aspect) {
    return f.x / f.y < aspect ? Frustum{f.y * aspect, f.y} : Frustum{f.x, f.x / aspect};
}

/// The part of the frustum of a whole picture that one of another size shows, or shows with a
/// margin: the middle, with pixels of the same angle.
Frustum cutOut(Frustum f, const PictureSize& whole, const PictureSize& picture) {
    const double pixelsPerUnit = whole.width / (2 * f.x); // focal length in pixels
    return {picture.width / (2 * pixelsPerUnit), picture.height / (2 * pixelsPerUnit)};
}

Frustum framedFrustum(const FileCamera& optics, const PictureSize& picture,
                      const FramingConventions& conventions) {
    // Framing needs an angle; an orthographic camera has none.
    const bool orthographic = optics.projection == Projection::Orthographic;
    const PictureSize whole = conventions.pictureSize.value_or(PictureSize{});
    const Frustum f = widen(
        orthographic ? defaultFrustum() : fileFrustum(optics, aspectOf(picture)), aspectOf(whole));
    return conventions.pictureSize ? cutOut(f, whole, picture) : widen(f, aspectOf(picture));
}

bool usesFile(const Scene& scene, CameraChoice choice, const FramingConventions& conventions) {
    if (choice == CameraChoice::Automatic)
        return !conventions.framesEveryScene && !scene.cglDialect && !scene.cameras.empty();
    return choice == CameraChoice::File;
}

/// The camera where the file puts it.
Camera fileView(const FileCamera& file) {
    Camera camera;
    camera.position = file.position;
    camera.right = file.right;
    camera.up = file.up;
    camera.back = file.back;
    return camera;
}

/// Direction from the world's origin to the point one unit in front of the file's camera: where
/// framed views look from.
glm::dvec3 framingDirection(const Scene& scene) {
    if (scene.cameras.empty()) return {0, 0, 1};
    const glm::dvec3 d = scene.cameras.back().pointAhead;
    return glm::length(d) > 0 ? glm::normalize(d) : glm::dvec3(0, 0, 1);
}

/// On a line through the middle of the bounding box, 1.5 times
/// its diagonal away, y up.
Camera framedView(const Scene& scene) {
    const Bounds bounds = scene.framing.value_or(scene.bounds());
    const glm::dvec3 low = bounds.empty() ? glm::dvec3(-0.5) : glm::dvec3(bounds.lo);
    const glm::dvec3 high = bounds.empty() ? glm::dvec3(0.5) : glm::dvec3(bounds.hi);
    const glm::dvec3 d = framingDirection(scene);
    double phi = std::acos(std::clamp(d.y, -1.0, 1.0));
    const double theta = std::atan2(d.x, d.z);
    if (std::sin(phi) == 0) phi += 1e-5; // radians: looking straight down leaves open what is up
    Camera camera;
    camera.back = {std::sin(phi) * std::sin(theta), std::cos(phi), std::sin(phi) * std::cos(theta)};
    camera.position = 0.5 * (low + high) + 1.5 * glm::length(high - low) * camera.back;
    camera.right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), camera.back));
    camera.up = glm::cross(camera.back, camera.right);
    return camera;
}

FileCamera opticsOf(const Scene& scene) {
    FileCamera optics;
    if (!scene.cameras.empty()) optics = scene.cameras.back();
    return optics;
}

} // namespace

Camera lookingAt(const glm::dvec3& from, const glm::dvec3& at, double halfWidth) {
    Camera camera;
    camera.position = from;
    camera.back = glm::normalize(from - at);
    const glm::dvec3 up = std::abs(camera.back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    camera.right = glm::normalize(glm::cross(up, camera.back));
    camera.up = glm::cross(camera.back, camera.right);
    camera.halfWidth = camera.halfHeight = halfWidth;
    return camera;
}

FramingConventions cs184Framing() {
    return {.pictureSize = PictureSize{800, 600}, .framesEveryScene = true, .clipsAlongRay = true};
}

PictureSize defaultPictureSize(const Scene& scene, CameraChoice choice,
                               const FramingConventions& conventions) {
    if (conventions.pictureSize) return *conventions.pictureSize;
    if (scene.cameras.empty() || !usesFile(scene, choice, conventions)) return {};
    const Frustum f = fileFrustum(scene.cameras.back(), aspectOf({}));
    PictureSize size;
    size.height = uint32_t(std::clamp(std::round(size.width * f.y / f.x), 1.0, 16384.0));
    return size;
}

Camera makeCamera(const Scene& scene, CameraChoice choice, uint32_t width, uint32_t height,
                  const FramingConventions& conventions) {
    const bool fromFile = usesFile(scene, choice, conventions);
    if (fromFile && scene.cameras.empty())
        throw SceneError(scene.file + ": has no camera; use --camera frame");
    const FileCamera optics = opticsOf(scene);
    const PictureSize picture{width, height};
    const double aspect = aspectOf(picture);
    Camera camera = fromFile ? fileView(optics) : framedView(scene);
    camera.orthographic = fromFile && optics.projection == Projection::Orthographic;
    const Frustum f = fromFile ? widen(fileFrustum(optics, aspect), aspect)
                               : framedFrustum(optics, picture, conventions);
    camera.halfWidth = f.x;
    camera.halfHeight = f.y;
    camera.clipAlongRay = conventions.clipsAlongRay;
    if (!scene.cameras.empty()) {
        camera.nearDistance = optics.nearDistance;
        camera.farDistance = optics.farDistance;
    }
    return camera;
}

} // namespace stromboli
