#include "scene/camera/focus.hpp"

#include "host/core/error.hpp"
#include "scene/model/meet_triangle.hpp"
#include "scene/model/surface_lookup.hpp"
#include "scene/model/world_triangles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace stromboli {
namespace {

/// A ray of the camera without its lens, as long per unit as its depth grows.
struct DepthRay {
    glm::dvec3 origin, direction;
    double nearest = std::numeric_limits<double>::infinity();
};

DepthRay rayThrough(const Camera& camera, const glm::dvec2& place) {
    const glm::dvec3 offset =
        ((2 * place.x - 1) * camera.halfWidth + camera.shift.x) * camera.right +
        ((1 - 2 * place.y) * camera.halfHeight + camera.shift.y) * camera.up;
    if (camera.orthographic) return {camera.position + offset, -camera.back};
    return {camera.position, offset - camera.back};
}

bool isSeen(const Material& material) {
    return !material.isHiddenFromCamera && !material.isNull();
}

/// Surfaces that are partly there count as what most of their light says.
constexpr double kThere = 0.5;

class DepthSearch {
  public:
    DepthSearch(const Camera& camera, const Scene& scene) : camera_(camera), scene_(scene) {}

    void triangle(DepthRay& ray, const std::array<glm::dvec3, 3>& corners, uint32_t index) const {
        const auto met = meetTriangle(ray.origin, ray.direction, corners);
        if (!met || !counts(ray, met->t)) return;
        const Material& material = scene_.materials[scene_.triangles[index].material];
        if (material.alphaMode != AlphaMode::Opaque &&
            opacityAt(scene_, material, attributesAt(scene_, index, met->b1, met->b2)) < kThere)
            return;
        ray.nearest = met->t;
    }

    void sphere(DepthRay& ray, const Sphere& sphere) const {
        const Material& material = scene_.materials[sphere.material];
        if (!isSeen(material) || opacityAt(scene_, material, {}) < kThere) return;
        const glm::dvec3 from = ray.origin - glm::dvec3(sphere.center);
        const double a = glm::dot(ray.direction, ray.direction), b = glm::dot(from, ray.direction),
                     c = glm::dot(from, from) - double(sphere.radius) * double(sphere.radius);
        const double root = b * b - a * c;
        if (root < 0) return;
        for (const double depth : {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a})
            if (counts(ray, depth)) {
                ray.nearest = depth;
                return;
            }
    }

  private:
    bool counts(const DepthRay& ray, double depth) const {
        const double along = camera_.clipAlongRay ? depth * glm::length(ray.direction) : depth;
        return depth > 0 && depth < ray.nearest && along > camera_.nearDistance &&
               along < camera_.farDistance;
    }

    const Camera& camera_;
    const Scene& scene_;
};

/// The middle ninth of a picture, or all of it, by rays on a grid: the median of the depths that
/// they meet; infinite if they meet nothing.
double depthOfMiddle(const Camera& camera, const Scene& scene) {
    constexpr int kRays = 5; // on a side
    for (const double part : {1.0 / 3, 1.0}) {
        std::vector<glm::dvec2> places;
        for (int y = 0; y < kRays; ++y)
            for (int x = 0; x < kRays; ++x)
                places.push_back(0.5 + part * (glm::dvec2(x + 0.5, y + 0.5) / double(kRays) - 0.5));
        std::vector<double> depths = depthsSeen(camera, scene, places);
        std::erase_if(depths, [](double depth) { return !std::isfinite(depth); });
        if (depths.empty()) continue;
        const auto median = depths.begin() + long(depths.size() / 2);
        std::nth_element(depths.begin(), median, depths.end());
        return *median;
    }
    return std::numeric_limits<double>::infinity();
}

double depthOfPixel(const Camera& camera, const Scene& scene, const glm::dvec2& pixel,
                    const PictureSize& picture) {
    if (pixel.x >= picture.width || pixel.y >= picture.height)
        throw SceneError(fmt::format("the pixel to focus on, {:g} {:g}, is not inside the picture "
                                     "of {} x {}",
                                     pixel.x, pixel.y, picture.width, picture.height));
    return depthsSeen(camera, scene,
                      {(pixel + 0.5) / glm::dvec2(picture.width, picture.height)})[0];
}

} // namespace

Focus Focus::onMiddle() {
    Focus focus;
    focus.on = On::Middle;
    return focus;
}

Focus Focus::onPixel(const glm::dvec2& pixel) {
    Focus focus;
    focus.on = On::Pixel;
    focus.pixel = pixel;
    return focus;
}

std::vector<double> depthsSeen(const Camera& camera, const Scene& scene,
                               const std::vector<glm::dvec2>& places) {
    std::vector<DepthRay> rays;
    for (const glm::dvec2& place : places)
        rays.push_back(rayThrough(camera, place));
    const DepthSearch search(camera, scene);
    forTrianglesInWorld(
        scene, isSeen,
        [&](const std::array<glm::dvec3, 3>& corners, double, uint32_t triangle, uint32_t) {
            for (DepthRay& ray : rays)
                search.triangle(ray, corners, triangle);
        });
    std::vector<double> depths;
    for (DepthRay& ray : rays) {
        for (const Sphere& sphere : scene.spheres)
            search.sphere(ray, sphere);
        depths.push_back(ray.nearest);
    }
    return depths;
}

void focusLens(Camera& camera, const Scene& scene, const CameraRequest& request,
               const PictureSize& picture) {
    if (!(camera.lensRadius > 0)) {
        if (request.focus)
            throw SceneError(scene.file + ": the camera has no lens to focus; use --aperture");
        return;
    }
    if (!request.focus && !(request.aperture > 0)) return; // what the file says
    const Focus focus = request.focus.value_or(Focus::onMiddle());
    double distance = focus.distance;
    if (focus.on == Focus::On::Middle) distance = depthOfMiddle(camera, scene);
    if (focus.on == Focus::On::Pixel) distance = depthOfPixel(camera, scene, focus.pixel, picture);
    if (std::isfinite(distance)) {
        camera.focusDistance = distance;
        return;
    }
    // A lens that focuses by itself is sharp far away where there is nothing; what is asked for of
    // one pixel is an error.
    if (focus.on == Focus::On::Pixel)
        throw SceneError(fmt::format("{}: pixel {:g} {:g} shows nothing to focus on", scene.file,
                                     focus.pixel.x, focus.pixel.y));
    constexpr double kBlurredPixels = 1.0 / 16; // by which the farthest things are blurred
    const double pixel = 2 * camera.halfHeight / picture.height; // at distance 1
    camera.focusDistance = 2 * camera.lensRadius / (kBlurredPixels * pixel);
}

} // namespace stromboli
