#include "host/kernel/glass_before_lights.hpp"

#include "host/kernel/lamp_light.hpp"
#include "host/kernel/seen_places.hpp"

#include <algorithm>
#include <span>

namespace stromboli {
namespace {

/// Rays of the camera, squared, and what is looked at from each surface that they find.
constexpr uint32_t kSide = 24;
constexpr size_t kLookedAt = 4;

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

Arriving fromLamps(const SceneRays& rays, std::span<const Place> places,
                   std::span<const Lamp> lamps, Random& random) {
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

Arriving fromSky(const SceneRays& rays, std::span<const Place> places, Random& random) {
    Arriving arriving;
    for (const Place& p : places)
        for (size_t k = 0; k < kLookedAt; ++k) {
            const glm::dvec3 d(aboutNormal(p.normal, random));
            const Found found = rays.follow(rays.leave(p.point, p.normal, d, p.hit));
            if (!found.hit && found.keepsDirection(glm::vec3(d))) arriving.add(found, 1);
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
    const SceneRays rays(scene, packed, true);
    const std::vector<Place> places = placesSeen(rays, packed, camera, kSide, random);
    double share = 0;
    if (!lamps.empty()) share = fromLamps(rays, places, lamps, random).share();
    if (hasSky) share = std::max(share, fromSky(rays, places, random).share());
    return share;
}

SeesThrough clearGlassOf(const GpuScene& packed) {
    return [&packed](uint32_t place) { return isClearAtPlace(packed, place); };
}

} // namespace stromboli
