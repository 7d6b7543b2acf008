#include "scene/camera/camera.hpp"
#include "scene/model/placements.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli {
namespace {

/// How far a point is outside of each of the planes that bound what a camera sees, negative inside:
/// left, right, bottom, top, near, far.
using Distances = std::array<double, 6>;

class Volume {
  public:
    explicit Volume(const Camera& camera)
        : camera_(camera),
          // How much one unit of depth widens the view, on each side; an orthographic view does not
          // widen.
          slopeX_(camera.orthographic ? 0 : camera.halfWidth),
          slopeY_(camera.orthographic ? 0 : camera.halfHeight) {
        // A ray is at most so much longer than its depth: in the corners of the picture.
        const double cornerX = slopeX_ + std::abs(camera.shift.x);
        const double cornerY = slopeY_ + std::abs(camera.shift.y);
        const double stretch = std::sqrt(1 + cornerX * cornerX + cornerY * cornerY);
        nearDepth_ = camera.clipAlongRay ? camera.nearDistance / stretch : camera.nearDistance;
    }

    Distances distances(const glm::dvec3& point) const {
        const glm::dvec3 v = point - camera_.position;
        const double depth = -glm::dot(v, camera_.back);
        const Side x =
            side(glm::dot(v, camera_.right), depth, camera_.halfWidth, slopeX_, camera_.shift.x);
        const Side y =
            side(glm::dot(v, camera_.up), depth, camera_.halfHeight, slopeY_, camera_.shift.y);
        return {x.low, x.high, y.low, y.high, nearDepth_ - depth, depth - camera_.farDistance};
    }

  private:
    struct Side {
        double low, high;
    };
    /// A point that is so far along one of the picture's axes, outside of the planes on both sides.
    Side side(double at, double depth, double halfExtent, double slope, double shift) const {
        const double extent = camera_.orthographic ? halfExtent : slope * depth;
        const double fromMiddle = at - shift * depth;
        return {(-fromMiddle - extent) / std::hypot(1, slope - shift),
                (fromMiddle - extent) / std::hypot(1, slope + shift)};
    }

    const Camera& camera_;
    double slopeX_, slopeY_, nearDepth_ = 0;
};

bool mayMeet(const Volume& volume, const Scene& scene, const Triangle& triangle) {
    Distances least;
    least.fill(HUGE_VAL);
    for (const uint32_t corner : triangle.corner) {
        const Distances d = volume.distances(scene.positions[corner]);
        for (size_t i = 0; i < d.size(); ++i)
            least[i] = std::min(least[i], d[i]);
    }
    return std::all_of(least.begin(), least.end(), [](double d) { return d <= 0; });
}

/// A box that has a corner on the inner side of each plane.
bool mayMeet(const Volume& volume, const Bounds& box) {
    Distances least;
    least.fill(HUGE_VAL);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p((corner & 1) != 0 ? box.hi.x : box.lo.x,
                          (corner & 2) != 0 ? box.hi.y : box.lo.y,
                          (corner & 4) != 0 ? box.hi.z : box.lo.z);
        const Distances d = volume.distances(p);
        for (size_t i = 0; i < d.size(); ++i)
            least[i] = std::min(least[i], d[i]);
    }
    return std::all_of(least.begin(), least.end(), [](double d) { return d <= 0; });
}

bool mayMeet(const Volume& volume, const Sphere& sphere) {
    const Distances d = volume.distances(sphere.center);
    return std::all_of(d.begin(), d.end(),
                       [&](double one) { return one <= double(sphere.radius); });
}

} // namespace

bool mayShow(const Camera& camera, const Scene& scene) {
    const Volume volume(camera);
    const std::vector<Bounds> prototypes = prototypeBounds(scene);
    const auto firstInWorld = scene.triangles.begin() + scene.firstInWorld();
    return std::any_of(firstInWorld, scene.triangles.end(),
                       [&](const Triangle& t) { return mayMeet(volume, scene, t); }) ||
           std::any_of(scene.placements.begin(), scene.placements.end(),
                       [&](const Placement& p) {
                           return mayMeet(volume, boundsInWorld(p, prototypes[p.prototype]));
                       }) ||
           std::any_of(scene.spheres.begin(), scene.spheres.end(),
                       [&](const Sphere& s) { return mayMeet(volume, s); });
}

} // namespace stromboli
