#include "host/kernel/light_notes.hpp"

#include "host/kernel/feelers.hpp"
#include "host/kernel/glass_before_lights.hpp"
#include "host/kernel/seen_places.hpp"
#include "host/kernel/sky_picture.hpp"
#include "shaders/shared/medium_types.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace stromboli {

// --- Whether there may be something to gain ------------------------------------------------------

bool seesSkyInPart(const GpuScene& scene, const Camera& camera) {
    constexpr uint32_t kSide = 20, kRays = 4;
    /// Where more than this share of the rays from what the camera sees meets nothing, light
    /// samples arrive in any case.
    constexpr double kOpenShare = 0.3;
    Random random(1);
    const SeesThrough glass = scene.glassBeforeLights > 0 ? clearGlassOf(scene) : SeesThrough();
    const Feelers seen = lookAround(scene.bvh, camera, kSide, glass);
    const Feelers once = feelFrom(scene.bvh, seen, kRays, random, glass);
    const double free = shareOfFree(once).value_or(1);
    if (free > 0) return free <= kOpenShare;
    return shareOfFree(feelFrom(scene.bvh, once, kRays, random, glass)).value_or(0) > 0;
}

// --- Notes ---------------------------------------------------------------------------------------

std::vector<LightNote> noteLightSamples(const Scene& scene, const GpuScene& packed,
                                        const Camera& camera, bool goThroughGlass) {
    /// Rays of the camera, squared, and bounces from where they end; light samples of each place.
    constexpr uint32_t kSide = 48;
    constexpr int kBounces = 2;
    constexpr size_t kOfPlace = 8;
    Random random(47);
    const SkyPicture sky(*packed.lights.environment);
    const SceneRays rays(scene, packed, goThroughGlass);
    const std::vector<Place> places = placesSeen(rays, packed, camera, kSide, random, kBounces);
    std::vector<LightNote> notes(places.size() * kOfPlace);
    for (LightNote& n : notes)
        n.direction = glm::vec3(sky.sample(random));
    tbb::parallel_for(size_t(0), notes.size(), [&](size_t i) {
        const Place& place = places[i / kOfPlace];
        LightNote& note = notes[i];
        const double cosine = glm::dot(glm::dvec3(note.direction), place.normal);
        const glm::dvec3 n = place.isLitFromBehind && cosine < 0 ? -place.normal : place.normal;
        note.position = glm::vec3(place.point);
        note.normal = glm::vec3(n);
        note.isOfOdd = i / kOfPlace % 2 == 1;
        if (!(glm::dot(glm::dvec3(note.direction), n) > 0)) return;
        const WayToSky way =
            rays.followToSky(rays.leave(place.point, n, note.direction, place.hit));
        if (way.isFree) note.value = float(std::abs(cosine));
    });
    return notes;
}

std::optional<LightGuide> guideThatPays(const Scene& scene, const GpuScene& packed,
                                        const Camera& camera, bool goThroughGlass) {
    /// More guided samples face their surfaces and need a ray, which takes a fifth of the picture's
    /// time, and they are not all of its noise.
    constexpr double kGainThatPays = 1.2;
    // Samples that media take are not noted.
    if ((packed.media & gpu::MEDIA_SCATTER) || !seesSkyInPart(packed, camera)) return std::nullopt;
    LightGuide guide = learnLightGuide(noteLightSamples(scene, packed, camera, goThroughGlass),
                                       *packed.lights.environment);
    if (guide.gain < kGainThatPays) return std::nullopt;
    return guide;
}

} // namespace stromboli
