#include "scene/camera/camera.hpp"

#include "host/core/error.hpp"
#include "scene/camera/focus.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

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

/// The cameras by number and name, for messages.
std::string listOf(const std::vector<FileCamera>& cameras) {
    std::string list;
    for (size_t i = 0; i < cameras.size(); ++i)
        list += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i + 1, cameras[i].name);
    return list;
}

/// The number from 1 to `count` that a text is; nothing if it is none.
std::optional<size_t> numberOf(const std::string& text, size_t count) {
    size_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || last != end || number < 1 || number > count) return std::nullopt;
    return number;
}

/// The file's camera that is meant; the default one if it has none.
FileCamera opticsOf(const Scene& scene, const CameraRequest& request,
                    const FramingConventions& conventions) {
    const std::optional<size_t> chosen = chosenCamera(scene, request, conventions);
    return chosen ? scene.cameras[*chosen] : FileCamera{};
}

/// The camera where the file puts it.
Camera fileView(const FileCamera& file) {
    Camera camera;
    camera.position = file.position;
    camera.right = file.right;
    camera.up = file.up;
    camera.back = file.back;
    camera.shift = file.shift;
    camera.lensRadius = file.lensRadius;
    camera.focusDistance = file.focusDistance;
    camera.medium = file.medium;
    return camera;
}

/// Where framed views look from: the direction from the world's origin to the point one unit in
/// front of the file's camera.
glm::dvec3 framingDirection(const Scene& scene, const FileCamera& optics,
                            const FramingConventions& conventions) {
    if (scene.cameras.empty()) return glm::normalize(conventions.directionWithoutCamera);
    const glm::dvec3 d = optics.pointAhead;
    return glm::length(d) > 0 ? glm::normalize(d) : glm::dvec3(0, 0, 1);
}

/// On a line through the middle of the bounding box, 1.5 times
/// its diagonal away, y up.
Camera framedView(const Scene& scene, const FileCamera& optics,
                  const FramingConventions& conventions) {
    const Bounds bounds = scene.framed();
    const glm::dvec3 low = bounds.empty() ? glm::dvec3(-0.5) : glm::dvec3(bounds.lo);
    const glm::dvec3 high = bounds.empty() ? glm::dvec3(0.5) : glm::dvec3(bounds.hi);
    const glm::dvec3 d = framingDirection(scene, optics, conventions);
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

/// Points that together tell how far the scene reaches, about its middle.
std::vector<glm::dvec3> outlineOf(const Scene& scene, const Bounds& bounds, bool turns) {
    const glm::dvec3 middle = 0.5 * (glm::dvec3(bounds.lo) + glm::dvec3(bounds.hi));
    std::vector<glm::dvec3> points;
    const auto addBox = [&](const Bounds& box) {
        for (int corner = 0; corner < 8; ++corner)
            points.push_back(glm::dvec3(corner & 1 ? box.hi.x : box.lo.x,
                                        corner & 2 ? box.hi.y : box.lo.y,
                                        corner & 4 ? box.hi.z : box.lo.z) -
                             middle);
    };
    if (turns) {
        constexpr int kTurns = 32;
        addBox(bounds);
        const std::vector<glm::dvec3> corners = points;
        for (int i = 1; i < kTurns; ++i) {
            const double c = std::cos(2 * std::numbers::pi * i / kTurns),
                         s = std::sin(2 * std::numbers::pi * i / kTurns);
            for (const glm::dvec3& p : corners)
                points.emplace_back(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
        }
        return points;
    }
    // What a scene frames may be less than all there is: a floor is left out.
    const auto isFramed = [&](const glm::vec3& p) {
        return glm::all(glm::greaterThanEqual(p, bounds.lo)) &&
               glm::all(glm::lessThanEqual(p, bounds.hi));
    };
    for (uint32_t t = scene.firstInWorld(); t < scene.triangles.size(); ++t)
        for (const uint32_t corner : scene.triangles[t].corner)
            if (isFramed(scene.positions[corner]))
                points.push_back(glm::dvec3(scene.positions[corner]) - middle);
    const std::vector<Bounds> prototypes = prototypeBounds(scene);
    for (const Placement& p : scene.placements)
        addBox(boundsInWorld(p, prototypes[p.prototype]));
    for (const Sphere& s : scene.spheres) {
        Bounds box;
        box.extend(s.center - glm::vec3(s.radius));
        box.extend(s.center + glm::vec3(s.radius));
        if (isFramed(box.lo) && isFramed(box.hi)) addBox(box);
    }
    if (points.empty()) addBox(bounds);
    return points;
}

/// From so far along this axis, and so far beside it, that the points just fill a view of this
/// tangent: where p is their place across the axis and z that along it, |p - beside| <=
/// tangent (distance - z).
struct Fit {
    double distance = 0, beside = 0;
};
Fit fitOf(const std::vector<glm::dvec3>& points, const glm::dvec3& across, const glm::dvec3& back,
          double tangent) {
    double most = -1e300, least = 1e300;
    for (const glm::dvec3& p : points) {
        const double at = glm::dot(p, across), depth = tangent * glm::dot(p, back);
        most = std::max(most, at + depth);
        least = std::min(least, at - depth);
    }
    return {(most - least) / (2 * tangent), (most + least) / 2};
}

/// As close as shows all of the scene, with a margin of a twentieth of the picture at each side.
void moveToFill(Camera& camera, const Scene& scene, const Frustum& f, bool turns) {
    const Bounds bounds = scene.framed();
    if (bounds.empty()) return;
    constexpr double kFilled = 0.9;
    const std::vector<glm::dvec3> points = outlineOf(scene, bounds, turns);
    const Fit x = fitOf(points, camera.right, camera.back, kFilled * f.x),
              y = fitOf(points, camera.up, camera.back, kFilled * f.y);
    const double distance = std::max(x.distance, y.distance);
    if (!(distance > 0) || !std::isfinite(distance)) return; // a point
    const glm::dvec3 middle = 0.5 * (glm::dvec3(bounds.lo) + glm::dvec3(bounds.hi));
    camera.position =
        middle + x.beside * camera.right + y.beside * camera.up + distance * camera.back;
}

/// The angle that a view without a camera has if none is asked for.
constexpr double kStatedView = 40 * kDegree;

Camera statedView(const Scene& scene, const CameraRequest& request) {
    const Bounds bounds = scene.framed();
    const glm::dvec3 middle =
        bounds.empty() ? glm::dvec3(0) : 0.5 * (glm::dvec3(bounds.lo) + glm::dvec3(bounds.hi));
    // What the user states is in the file's coordinates.
    const glm::dvec3 from = *request.from - scene.origin;
    const glm::dvec3 at = request.at ? *request.at - scene.origin : middle;
    if (at == from)
        throw SceneError(fmt::format("{}: the camera is where it is to look at: ({:g}, {:g}, {:g})",
                                     scene.file, request.from->x, request.from->y,
                                     request.from->z));
    return lookingAt(from, at, std::tan(kStatedView / 2));
}

void applyOptics(Camera& camera, const CameraRequest& request, double aspect,
                 const std::string& file) {
    if (camera.orthographic && (request.fieldOfView || request.aperture > 0 || request.focus))
        throw SceneError(
            fmt::format("{}: an orthographic camera has neither an angle of view nor a lens "
                        "(--fov, --aperture, --focus)",
                        file));
    if (request.fieldOfView) {
        const double halfHeight = std::tan(*request.fieldOfView / 2);
        camera.shift *= halfHeight / camera.halfHeight; // so much of the picture's height as before
        camera.halfHeight = halfHeight;
        camera.halfWidth = camera.halfHeight * aspect;
    }
    if (request.aperture > 0) camera.lensRadius = request.aperture / 2;
}

void turnAbout(Camera& camera, const Scene& scene, double angle) {
    if (angle == 0) return;
    const Bounds bounds = scene.framed();
    const glm::dvec3 middle =
        bounds.empty() ? glm::dvec3(0) : 0.5 * (glm::dvec3(bounds.lo) + glm::dvec3(bounds.hi));
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](const glm::dvec3& v) {
        return glm::dvec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
    };
    camera.position = middle + turned(camera.position - middle);
    for (glm::dvec3* axis : {&camera.right, &camera.up, &camera.back})
        *axis = turned(*axis);
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

std::optional<size_t> chosenCamera(const Scene& scene, const CameraRequest& request,
                                   const FramingConventions& conventions) {
    const std::vector<FileCamera>& cameras = scene.cameras;
    if (request.place) return request.place;
    if (request.name.empty()) {
        if (cameras.empty()) return std::nullopt;
        return conventions.lastOfSeveral ? cameras.size() - 1 : 0;
    }
    for (size_t i = 0; i < cameras.size(); ++i)
        if (cameras[i].name == request.name) return i;
    if (const std::optional<size_t> number = numberOf(request.name, cameras.size()))
        return *number - 1;
    throw SceneError(
        scene.file, 0, "",
        fmt::format("has no camera '{}'; {}", request.name,
                    cameras.empty() ? "it has none at all" : "it has " + listOf(cameras)));
}

bool isFramed(const Scene& scene, const CameraRequest& request,
              const FramingConventions& conventions) {
    if (request.from) return false;
    if (request.choice != CameraChoice::Automatic) return request.choice == CameraChoice::Frame;
    return conventions.framesEveryScene || scene.cglDialect || scene.cameras.empty();
}

PictureSize defaultPictureSize(const Scene& scene, const CameraRequest& request,
                               const FramingConventions& conventions) {
    if (conventions.pictureSize) return *conventions.pictureSize;
    if (request.from) return {};
    const std::optional<size_t> chosen = chosenCamera(scene, request, conventions);
    if (!chosen || isFramed(scene, request, conventions)) return {};
    if (scene.hints.width && scene.hints.height) return {*scene.hints.width, *scene.hints.height};
    const Frustum f = fileFrustum(scene.cameras[*chosen], aspectOf({}));
    PictureSize size;
    size.height = uint32_t(std::clamp(std::round(size.width * f.y / f.x), 1.0, 16384.0));
    return size;
}

Camera makeCamera(const Scene& scene, const CameraRequest& request, uint32_t width, uint32_t height,
                  const FramingConventions& conventions) {
    const PictureSize picture{width, height};
    const double aspect = aspectOf(picture);
    if (request.from) {
        Camera camera = statedView(scene, request);
        camera.halfWidth = camera.halfHeight * aspect;
        applyOptics(camera, request, aspect, scene.file);
        turnAbout(camera, scene, request.turn);
        focusLens(camera, scene, request, picture);
        camera.medium = mediumAt(scene, camera.position);
        return camera;
    }
    const bool framed = isFramed(scene, request, conventions);
    const FileCamera optics = opticsOf(scene, request, conventions);
    if (!framed && scene.cameras.empty())
        throw SceneError(scene.file + ": has no camera; use --camera frame");
    Camera camera = framed ? framedView(scene, optics, conventions) : fileView(optics);
    camera.orthographic = !framed && optics.projection == Projection::Orthographic;
    Frustum f = framed ? framedFrustum(optics, picture, conventions)
                       : widen(fileFrustum(optics, aspect), aspect);
    if (framed && conventions.fillsPicture && scene.cameras.empty() && !scene.cglDialect) {
        if (request.fieldOfView)
            f = {std::tan(*request.fieldOfView / 2) * aspect, std::tan(*request.fieldOfView / 2)};
        moveToFill(camera, scene, f, request.isOneOfTurns);
    }
    camera.halfWidth = f.x;
    camera.halfHeight = f.y;
    camera.clipAlongRay = conventions.clipsAlongRay;
    if (!framed || conventions.clipsFramedViews) {
        camera.nearDistance = optics.nearDistance;
        camera.farDistance = optics.farDistance;
    }
    applyOptics(camera, request, aspect, scene.file);
    turnAbout(camera, scene, request.turn);
    focusLens(camera, scene, request, picture);
    // What the file says holds for where the file puts its camera.
    const bool isStated = !framed && request.turn == 0 && scene.surrounding == kNoMedium;
    if (!isStated) camera.medium = mediumAt(scene, camera.position);
    return camera;
}

} // namespace stromboli
