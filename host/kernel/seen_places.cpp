#include "host/kernel/seen_places.hpp"

#include "host/kernel/feelers.hpp"
#include "host/kernel/lamp_light.hpp"

#include <algorithm>
#include <utility>

namespace stromboli {

// --- Rays ----------------------------------------------------------------------------------------

/// Surfaces that may be partly not there, which a ray goes straight through at most.
constexpr int kMostGaps = 64;

bool Found::keepsDirection(const glm::vec3& first) const {
    const glm::dvec3 turn = glm::dvec3(ray.direction) - glm::dvec3(first);
    return glm::dot(turn, turn) <= double(gpu::SAME_DIRECTION);
}

SceneRays::SceneRays(const Scene& scene, const GpuScene& packed, bool goThroughGlass)
    : scene_(scene), packed_(packed), goThroughGlass_(goThroughGlass),
      someIsNotThere_(std::ranges::any_of(
          scene.materials, [](const Material& m) { return m.alphaMode != AlphaMode::Opaque; })) {}

WayToSky SceneRays::followToSky(const TraversalRay& ray) const {
    if (!goThroughGlass_ && !someIsNotThere_) return {!anyHit(packed_.bvh, ray)};
    const Found found = followToLight(ray);
    return {!found.hit && found.keepsDirection(ray.direction), found.panes};
}

Found SceneRays::followToLight(const TraversalRay& ray) const {
    Found found{ray, closestHit(packed_.bvh, ray)};
    for (int gap = 0; gap < kMostGaps && found.hit && mayBeNotThere(found.hit); ++gap) {
        goThrough(packed_.bvh, found.ray, found.hit);
        found.hit = closestHit(packed_.bvh, found.ray);
    }
    return throughGlass(found);
}

Found SceneRays::follow(const TraversalRay& ray) const {
    return throughGlass({ray, closestHit(packed_.bvh, ray)});
}

Found SceneRays::throughGlass(Found found) const {
    while (goThroughGlass_ && found.hit && isClear(found.hit) &&
           found.panes < int(gpu::MOST_PANES)) {
        const std::optional<TraversalRay> bent = throughSurface(found.ray, found.hit);
        if (!bent) break;
        found.ray = *bent;
        found.hit = closestHit(packed_.bvh, found.ray);
        ++found.panes;
    }
    return found;
}

bool SceneRays::mayBeNotThere(const TraversalHit& hit) const {
    const Material& m = scene_.materials[materialNumberAt(scene_, packed_.bvh, hit.primitive)];
    return m.alphaMode != AlphaMode::Opaque;
}

bool SceneRays::isClear(const TraversalHit& hit) const {
    return isClearAtPlace(packed_, hit.primitive);
}

bool SceneRays::emits(const TraversalHit& hit) const {
    return materialAtPlace(packed_, hit.primitive).emission != glm::vec3(0);
}

glm::dvec3 SceneRays::normalAt(const TraversalRay& ray, const TraversalHit& hit) const {
    if (const auto c = cornersAt(packed_.bvh, hit)) {
        const glm::dvec3 n =
            glm::cross(glm::dvec3((*c)[1] - (*c)[0]), glm::dvec3((*c)[2] - (*c)[0]));
        const double length = glm::length(n);
        return length > 0 ? n / length : glm::dvec3(0, 0, 1);
    }
    const glm::dvec3 center = placedSphere(packed_.bvh, hit.primitive).center;
    return glm::normalize(pointAt(ray, hit) - center);
}

glm::dvec3 SceneRays::pointAt(const TraversalRay& ray, const TraversalHit& hit) {
    return glm::dvec3(ray.origin) + double(hit.t) * glm::dvec3(ray.direction);
}

TraversalRay SceneRays::leave(const glm::dvec3& point, const glm::dvec3& n, const glm::dvec3& d,
                              const TraversalHit& hit) const {
    TraversalRay ray;
    const bool isTriangle = cornersAt(packed_.bvh, hit).has_value();
    ray.origin = glm::vec3(point + 0x1p-20 * (hit.t + glm::length(point)) * n);
    ray.direction = glm::vec3(d);
    if (isTriangle) ray.skipPrimitive = hit.primitive;
    return ray;
}

/// The index behind the surface over that before it, seen from outside; 1: light goes straight.
double SceneRays::indexAt(const TraversalHit& hit) const {
    const Material& m = scene_.materials[materialNumberAt(scene_, packed_.bvh, hit.primitive)];
    if (m.kind == MaterialKind::Principled)
        return m.principled.isThin ? 1 : double(m.principled.ior);
    return m.kind == MaterialKind::ThinDielectric ? 1 : double(m.ior);
}

std::optional<TraversalRay> SceneRays::throughSurface(const TraversalRay& ray,
                                                      const TraversalHit& hit) const {
    const glm::dvec3 d = glm::normalize(glm::dvec3(ray.direction));
    glm::dvec3 n = normalAt(ray, hit);
    const bool isOutside = glm::dot(n, d) <= 0;
    if (!isOutside) n = -n;
    const double index = indexAt(hit), eta = isOutside ? 1 / index : index;
    const glm::dvec3 on = index == 1 ? d : glm::refract(d, n, eta);
    if (on == glm::dvec3(0)) return std::nullopt; // total reflection
    return leave(pointAt(ray, hit), -n, on, hit);
}

// --- Places --------------------------------------------------------------------------------------

namespace {

/// What a ray sees that scatters light into many directions, through glass, too.
std::optional<Place> placeSeen(const SceneRays& rays, const GpuScene& packed,
                               const TraversalRay& ray) {
    constexpr uint32_t kScatteringOn = gpu::TRANSMISSION_LOBES & ~gpu::DELTA_LOBES;
    const Found found = rays.follow(ray);
    if (!found.hit || rays.isClear(found.hit) || rays.emits(found.hit)) return std::nullopt;
    Place place{SceneRays::pointAt(found.ray, found.hit), rays.normalAt(found.ray, found.hit),
                found.hit};
    place.isLitFromBehind =
        (materialAtPlace(packed, found.hit.primitive).closures & kScatteringOn) != 0;
    if (glm::dot(place.normal, glm::dvec3(found.ray.direction)) > 0) place.normal = -place.normal;
    return place;
}

} // namespace

std::vector<Place> placesSeen(const SceneRays& rays, const GpuScene& packed, const Camera& camera,
                              uint32_t side, Random& random, int bounces) {
    std::vector<Place> places;
    for (const Feeler& f : lookAround(packed.bvh, camera, side)) {
        TraversalRay ray;
        ray.origin = f.origin, ray.direction = f.direction;
        if (const auto place = placeSeen(rays, packed, ray)) places.push_back(*place);
    }
    size_t first = 0;
    for (int bounce = 0; bounce < bounces; ++bounce) {
        const size_t end = places.size();
        for (size_t i = std::exchange(first, end); i < end; ++i) {
            const Place p = places[i];
            const glm::dvec3 d(aboutNormal(p.normal, random));
            if (const auto place = placeSeen(rays, packed, rays.leave(p.point, p.normal, d, p.hit)))
                places.push_back(*place);
        }
    }
    return places;
}

} // namespace stromboli
