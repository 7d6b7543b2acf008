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
// The CS184 renderer's picture at load time, to which its framing belongs, and its default
// fields of view.
constexpr double kCs184Width = 800, kCs184Height = 600;
constexpr double kDefaultX = 50 * kDegree, kDefaultY = 35 * kDegree;

/// What the file states; the picture's own shape gives the extent that it leaves open.
Frustum fileFrustum(const FileCamera& camera, double pictureAspect) {
    const std::optional<double>&x = camera.halfWidth, &y = camera.halfHeight;
    if (x && y) return {*x, *y};
    if (x) return {*x, *x / pictureAspect};
    if (y) return {*y * pictureAspect, *y};
    return {std::tan(kDefaultX / 2), std::tan(kDefaultY / 2)};
}

/// Widens the frustum to the picture's shape so that nothing of it is lost.
Frustum widen(Frustum f, double aspect) {
    return f.x / f.y < aspect ? Frustum{f.y * aspect, f.y} : Frustum{f.x, f.x / aspect};
}

bool usesFile(const Scene& scene, CameraChoice choice) {
    if (choice == CameraChoice::Automatic) return !scene.cglDialect && !scene.cameras.empty();
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
/// the CS184 renderer looks from.
glm::dvec3 framingDirection(const Scene& scene) {
    if (scene.cameras.empty()) return {0, 0, 1};
    const glm::dvec3 d = scene.cameras.back().pointAhead;
    return glm::length(d) > 0 ? glm::normalize(d) : glm::dvec3(0, 0, 1);
}

/// The CS184 renderer's placement: on a line through the middle of the bounding box, 1.5 times
/// its diagonal away, y up.
Camera framedView(const Scene& scene) {
    const Bounds bounds = scene.framing.value_or(scene.bounds());
    const glm::dvec3 low = bounds.empty() ? glm::dvec3(-0.5) : glm::dvec3(bounds.lo);
    const glm::dvec3 high = bounds.empty() ? glm::dvec3(0.5) : glm::dvec3(bounds.hi);
    const glm::dvec3 d = framingDirection(scene);
    double phi = std::acos(std::clamp(d.y, -1.0, 1.0));
    const double theta = std::atan2(d.x, d.z);
    if (std::sin(phi) == 0)
        phi += 1e-5; // radians: that renderer's way out of looking straight down
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

PictureSize defaultPictureSize(const Scene& scene, CameraChoice choice, bool cs184) {
    if (cs184 || scene.cameras.empty() || !usesFile(scene, choice)) return {};
    const Frustum f = fileFrustum(scene.cameras.back(), kCs184Width / kCs184Height);
    PictureSize size;
    size.height = uint32_t(std::clamp(std::round(size.width * f.y / f.x), 1.0, 16384.0));
    return size;
}

Camera makeCamera(const Scene& scene, CameraChoice choice, uint32_t width, uint32_t height,
                  bool cs184) {
    const bool fromFile = usesFile(scene, choice) && !(cs184 && choice == CameraChoice::Automatic);
    if (fromFile && scene.cameras.empty())
        throw SceneError(scene.file + ": has no camera; use --camera frame");
    const FileCamera optics = opticsOf(scene);
    const double aspect = double(width) / double(height);
    Camera camera = fromFile ? fileView(optics) : framedView(scene);
    Frustum f = fileFrustum(optics, aspect);
    const bool orthographic = optics.projection == Projection::Orthographic;
    if (!fromFile && orthographic) {
        // Framing needs an angle; an orthographic camera has none.
        camera.orthographic = false;
        f = {std::tan(kDefaultX / 2), std::tan(kDefaultY / 2)};
    } else {
        camera.orthographic = orthographic;
    }
    if (!fromFile) f = widen(f, kCs184Width / kCs184Height);
    if (!fromFile && cs184) {
        const double pixelsPerUnit = kCs184Width / (2 * f.x); // focal length in pixels
        f = {width / (2 * pixelsPerUnit), height / (2 * pixelsPerUnit)};
    } else {
        f = widen(f, aspect);
    }
    camera.halfWidth = f.x;
    camera.halfHeight = f.y;
    camera.clipAlongRay = cs184;
    if (!scene.cameras.empty()) {
        camera.nearDistance = optics.nearDistance;
        camera.farDistance = optics.farDistance;
    }
    return camera;
}

} // namespace stromboli
