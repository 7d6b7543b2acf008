#include "host/kernel/glass_before_lights.hpp"

#include "host/kernel/lamp_light.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace stromboli {
namespace {

/// Rays of the camera, squared, and what is looked at from each surface that they find.
constexpr uint32_t kSide = 24;
constexpr size_t kLookedAt = 4;

/// What a ray has found: its closest hit, or the first one behind glass.
struct Found {
    TraversalRay ray; ///< the last of its segments
    TraversalHit hit;
    int panes = 0; ///< surfaces of glass on its way
};

class Rays {
  public:
    Rays(const Scene& scene, const GpuScene& packed) : scene_(scene), packed_(packed) {}

    /// Follows a ray through clear glass, bent, as far as that lets it through.
    Found follow(TraversalRay ray) const {
        Found found{ray, closestHit(packed_.bvh, ray)};
        while (found.hit && isClear(found.hit) && found.panes < int(gpu::MOST_PANES)) {
            const std::optional<TraversalRay> bent = throughSurface(found.ray, found.hit);
            if (!bent) break;
            found.ray = *bent;
            found.hit = closestHit(packed_.bvh, found.ray);
            ++found.panes;
        }
        return found;
    }

    bool isClear(const TraversalHit& hit) const { return isClearAtPlace(packed_, hit.primitive); }
    bool emits(const TraversalHit& hit) const {
        return materialAtPlace(packed_, hit.primitive).emission != glm::vec3(0);
    }

    /// Unit, as stored.
    glm::dvec3 normalAt(const TraversalRay& ray, const TraversalHit& hit) const {
        if (const auto c = cornersAt(packed_.bvh, hit)) {
            const glm::dvec3 n =
                glm::cross(glm::dvec3((*c)[1] - (*c)[0]), glm::dvec3((*c)[2] - (*c)[0]));
            const double length = glm::length(n);
            return length > 0 ? n / length : glm::dvec3(0, 0, 1);
        }
        const glm::dvec3 center = placedSphere(packed_.bvh, hit.primitive).center;
        return glm::normalize(pointAt(ray, hit) - center);
    }

    static glm::dvec3 pointAt(const TraversalRay& ray, const TraversalHit& hit) {
        return glm::dvec3(ray.origin) + double(hit.t) * glm::dvec3(ray.direction);
    }

    /// From a surface, whose side n points to, in direction d.
    TraversalRay leave(const glm::dvec3& point, const glm::dvec3& n, const glm::dvec3& d,
                       const TraversalHit& hit) const {
        TraversalRay ray;
        const bool isTriangle = cornersAt(packed_.bvh, hit).has_value();
        ray.origin = glm::vec3(point + 0x1p-20 * (hit.t + glm::length(point)) * n);
        ray.direction = glm::vec3(d);
        if (isTriangle) ray.skipPrimitive = hit.primitive;
        return ray;
    }

  private:
    /// The index behind the surface over that before it, seen from outside; 1: light goes straight.
    double indexAt(const TraversalHit& hit) const {
        const Material& m = scene_.materials[materialNumberAt(scene_, packed_.bvh, hit.primitive)];
        if (m.kind == MaterialKind::Principled)
            return m.principled.isThin ? 1 : double(m.principled.ior);
        return m.kind == MaterialKind::ThinDielectric ? 1 : double(m.ior);
    }

    std::optional<TraversalRay> throughSurface(const TraversalRay& ray,
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

    const Scene& scene_;
    const GpuScene& packed_;
};

struct Place {
    glm::dvec3 point, normal; ///< unit, to where it is seen from
    TraversalHit hit;
};

/// What a ray sees that scatters light into many directions, through glass, too.
std::optional<Place> placeSeen(const Rays& rays, const TraversalRay& ray) {
    const Found found = rays.follow(ray);
    if (!found.hit || rays.isClear(found.hit) || rays.emits(found.hit)) return std::nullopt;
    Place place{Rays::pointAt(found.ray, found.hit), rays.normalAt(found.ray, found.hit),
                found.hit};
    if (glm::dot(place.normal, glm::dvec3(found.ray.direction)) > 0) place.normal = -place.normal;
    return place;
}

std::vector<Place> placesSeen(const Rays& rays, const GpuScene& packed, const Camera& camera,
                              Random& random) {
    std::vector<Place> places;
    for (const Feeler& f : lookAround(packed.bvh, camera, kSide)) {
        TraversalRay ray;
        ray.origin = f.origin, ray.direction = f.direction;
        if (const auto place = placeSeen(rays, ray)) places.push_back(*place);
    }
    const size_t seen = places.size();
    for (size_t i = 0; i < seen; ++i) {
        const Place& p = places[i];
        const glm::dvec3 d(aboutNormal(p.normal, random));
        if (const auto place = placeSeen(rays, rays.leave(p.point, p.normal, d, p.hit)))
            places.push_back(*place);
    }
    return places;
}

/// Light that arrives straight, or bent by glass.
struct Arriving {
    double straight = 0, throughGlass = 0;

    void add(const Found& found, double light) {
        (found.panes > 0 ? throughGlass : straight) += light;
    }
    double share() const {
        const double all = straight + throughGlass;
        return all > 0 ? throughGlass / all : 0;
    }
};

/// Which lamp has this part of all power; parts: of the lamps, in order, summed up.
size_t lampAt(std::span<const double> parts, double at) {
    const auto found = std::ranges::upper_bound(parts, at * parts.back());
    return std::min(size_t(found - parts.begin()), parts.size() - 1);
}

Arriving fromLamps(const Rays& rays, std::span<const Place> places, std::span<const Lamp> lamps,
                   Random& random) {
    std::vector<double> parts;
    for (const Lamp& lamp : lamps)
        parts.push_back((parts.empty() ? 0 : parts.back()) + lamp.power);
    Arriving arriving;
    for (const Place& p : places)
        for (size_t k = 0; k < kLookedAt; ++k) {
            const TraversalRay light = leaveLamp(lamps[lampAt(parts, random.uniform())], random);
            const glm::dvec3 to = glm::dvec3(light.origin) - p.point;
            const double distance = glm::length(to), cosine = glm::dot(to, p.normal) / distance;
            if (!(cosine > 0)) continue;
            const Found found = rays.follow(rays.leave(p.point, p.normal, to / distance, p.hit));
            // Straight it may also end in the air before a lamp that shines to one side.
            const bool isFree =
                found.panes == 0 && (!found.hit || found.hit.t > distance * (1 - 0x1p-10));
            if (isFree || (found.hit && rays.emits(found.hit)))
                arriving.add(found, cosine / (distance * distance));
        }
    return arriving;
}

Arriving fromSky(const Rays& rays, std::span<const Place> places, Random& random) {
    Arriving arriving;
    for (const Place& p : places)
        for (size_t k = 0; k < kLookedAt; ++k) {
            const glm::dvec3 d(aboutNormal(p.normal, random));
            const Found found = rays.follow(rays.leave(p.point, p.normal, d, p.hit));
            const glm::dvec3 turn = glm::dvec3(found.ray.direction) - d;
            if (!found.hit && glm::dot(turn, turn) <= double(gpu::SAME_DIRECTION))
                arriving.add(found, 1);
        }
    return arriving;
}

} // namespace

double shareThroughGlass(const Scene& scene, const GpuScene& packed, const Camera& camera) {
    constexpr uint32_t kSkies = 1u << gpu::LIGHT_AMBIENT | 1u << gpu::LIGHT_ENVIRONMENT;
    if (!(packed.closures.some & gpu::LOBE_DELTA_TRANSMISSION)) return 0;
    const bool hasSky = (packed.lights.sampledKinds & kSkies) != 0;
    const std::vector<Lamp> lamps = sampledLamps(packed);
    if (!hasSky && lamps.empty()) return 0;
    Random random(37);
    const Rays rays(scene, packed);
    const std::vector<Place> places = placesSeen(rays, packed, camera, random);
    double share = 0;
    if (!lamps.empty()) share = fromLamps(rays, places, lamps, random).share();
    if (hasSky) share = std::max(share, fromSky(rays, places, random).share());
    return share;
}

SeesThrough clearGlassOf(const GpuScene& packed) {
    return [&packed](uint32_t place) { return isClearAtPlace(packed, place); };
}

} // namespace stromboli
