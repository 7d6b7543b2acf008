#include "host/reference/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace stromboli::reference {
namespace {

/// As many as the kernel remembers.
constexpr size_t kMostVolumesAtOnce = 4;

const Medium* mediumNumbered(const Scene& scene, uint32_t number) {
    return number == kNoMedium ? nullptr : &scene.media.at(number);
}

/// Bound of the distance between the surface at that point and one that is meant to lie in its
/// plane: errorOnTriangle() has 16 roundings of doubles, and positions are rounded to floats once.
double distanceOfCopy(const SurfacePoint& s) {
    return s.error * (1 + 0x1p-24 / (16 * kRoundoff));
}

/// Bound of the distance, along the normal, of the plane that is meant from where the ray meets the
/// surface.
double planeError(const Ray& ray, const SurfacePoint& s) {
    const glm::dvec3 o = glm::abs(ray.origin);
    return distanceOfCopy(s) + 16 * kRoundoff * (o.x + o.y + o.z);
}

} // namespace

Filling fillingOf(const Medium* medium) {
    return {nullptr, medium, {}, medium};
}

Filling behind(const Scene& scene, const SurfacePoint& s, const Filling& here) {
    const Material& m = *s.material;
    if (!m.boundsMedia) return here;
    Filling filling = here;
    const Medium* stated = mediumNumbered(scene, s.outside ? m.inside : m.outside);
    std::vector<uint32_t>& volumes = filling.volumes;
    if (!m.outsideIsOpen) {
        filling.around = stated;
    } else if (s.outside) {
        volumes.insert(std::ranges::upper_bound(volumes, m.inside, std::greater()), m.inside);
        if (volumes.size() > kMostVolumesAtOnce) volumes.pop_back();
    } else if (const auto left = std::ranges::find(volumes, m.inside); left != volumes.end()) {
        volumes.erase(left);
    } else { // the ray began in it
        filling.around = stated;
    }
    filling.medium = volumes.empty() ? filling.around : mediumNumbered(scene, volumes.front());
    return filling;
}

bool Crossing::isInPassedPlane(const Ray& ray, const SurfacePoint& s, double from, double t) const {
    const double beyond = (t - from) * std::abs(glm::dot(ray.direction, s.geometric));
    return error_ >= 0 && beyond <= error_ + planeError(ray, s);
}

Filling Crossing::pass(const Scene& scene, const Ray& ray, const SurfacePoint& s, double from,
                       double t, const Filling& here) {
    const bool isSamePlane = isInPassedPlane(ray, s, from, t);
    if (!isSamePlane) settled_ = here;
    error_ = planeError(ray, s);
    const Material& m = *s.material;
    const Medium* before = mediumNumbered(scene, s.outside ? m.outside : m.inside);
    // The border that says where the ray has come from is the first of two in one plane.
    // Volumes are in no order.
    const bool isOfMedia = m.boundsMedia && !m.outsideIsOpen;
    const bool isEarlier = isOfMedia && isSamePlane && isUntold_ && before == settled_.medium;
    isUntold_ = isOfMedia && !isEarlier && before != here.medium;
    return isEarlier ? here : behind(scene, s, here);
}

Filling Crossing::arrive(const Ray& ray, const SurfacePoint& s, double from, double t,
                         const Filling& here) const {
    return isInPassedPlane(ray, s, from, t) ? settled_ : here;
}

Ray rayThroughMedia(const Scene& scene, const SurfacePoint& s, const glm::dvec3& direction) {
    const bool isPane =
        !scene.media.empty() && !s.material->boundsMedia && s.triangle != kNoPrimitive;
    return isPane ? Ray{s.position + 2 * distanceOfCopy(s) * s.geometric, direction}
                  : transmittedRay(s, direction);
}

} // namespace stromboli::reference
