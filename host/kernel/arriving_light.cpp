#include "host/kernel/arriving_light.hpp"

#include "host/kernel/lamp_light.hpp"
#include "host/kernel/light_shares.hpp"
#include "host/kernel/seen_places.hpp"
#include "host/kernel/sky_picture.hpp"
#include "shaders/shared/medium_types.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace stromboli {

// --- What arrives --------------------------------------------------------------------------------

namespace {

/// Rays of the camera, squared.
constexpr uint32_t kSide = 16;
/// Lights that are asked for at each place, one after the other, and rays to the sky.
constexpr uint32_t kLightsOfPlace = 16, kRaysToSky = 4;

/// A light sample: what it brings if nothing is in its way, and whether that is so.
struct Asked {
    double light = 0; ///< irradiance, relative luminance
    bool arrives = false;
    int segments = 1; ///< of its ray
};

class Asker {
  public:
    Asker(const Scene& scene, const GpuScene& packed, bool goThroughGlass)
        : packed_(packed), rays_(scene, packed, goThroughGlass) {
        if (packed.lights.environment) sky_.emplace(*packed.lights.environment);
    }

    const SceneRays& rays() const { return rays_; }

    Asked ask(const Place& place, uint32_t number, Random& random) const {
        const LightBounds& bounds = packed_.lights.weighed->bounds[number];
        if (number == packed_.lights.ambientNumber) return askSky(place, bounds, random);
        if (const std::optional<Lamp> lamp = lampOfLight(packed_, number))
            return askLamp(place, *lamp, bounds, random);
        if (bounds.group == gpu::LIGHT_GROUP_INFINITE) return askSun(place, bounds);
        return askPoint(place, bounds);
    }

  private:
    TraversalRay rayTo(const Place& place, const glm::dvec3& w) const {
        const glm::dvec3 n = glm::dot(w, place.normal) < 0 ? -place.normal : place.normal;
        return rays_.leave(place.point, n, w, place.hit);
    }

    Found follow(const Place& place, const glm::dvec3& w) const {
        return rays_.followToLight(rayTo(place, w));
    }

    /// Of light from direction w: 0 where it falls on the side that is not lit.
    static double cosineAt(const Place& place, const glm::dvec3& w) {
        const double cosine = glm::dot(w, place.normal);
        return place.isLitFromBehind ? std::abs(cosine) : std::max(cosine, 0.0);
    }

    /// The environment by its picture, other ambient light by the cosine.
    Asked askSky(const Place& place, const LightBounds& bounds, Random& random) const {
        Asked asked;
        const bool isBehind = place.isLitFromBehind && random.uniform() < 0.5f;
        glm::dvec3 w(aboutNormal(isBehind ? -place.normal : place.normal, random));
        asked.light = bounds.power * (place.isLitFromBehind ? 2 : 1);
        if (sky_) {
            w = sky_->sample(random);
            asked.light = packed_.lights.environment->luminance * cosineAt(place, w);
        }
        if (!(asked.light > 0)) return {};
        const WayToSky way = rays_.followToSky(rayTo(place, w));
        asked.arrives = way.isFree;
        asked.segments = 1 + way.panes;
        return asked;
    }

    Asked askLamp(const Place& place, const Lamp& lamp, const LightBounds& bounds,
                  Random& random) const {
        LampPoint at = pointOf(lamp, random);
        const bool isSphere = lamp.radius > 0;
        if (isSphere && glm::dot(at.normal, place.point - lamp.corner) < 0)
            at = {2.0 * lamp.corner - at.point, -at.normal};
        const glm::dvec3 to = at.point - place.point;
        const double distance = glm::length(to);
        if (!(distance > 0)) return {};
        const glm::dvec3 w = to / distance;
        // Not nearer than the lamp is large: there its samples go by solid angle.
        const double least = lamp.radius * lamp.radius +
                             glm::length(glm::cross(lamp.edgeA, lamp.edgeB)) / std::numbers::pi;
        const double cosines =
            cosineAt(place, w) * (isSphere ? 1 : std::max(-glm::dot(w, at.normal), 0.0));
        Asked asked;
        asked.light = bounds.power * cosines / std::max(distance * distance, least);
        if (!(asked.light > 0)) return {};
        const Found found = follow(place, w);
        const bool isFree =
            found.panes == 0 && (!found.hit || found.hit.t > distance * (1 - 0x1p-10));
        asked.arrives = isFree || (found.hit && rays_.emits(found.hit));
        asked.segments = 1 + found.panes;
        return asked;
    }

    /// Lights without a surface end at glass.
    Asked askSun(const Place& place, const LightBounds& bounds) const {
        const glm::dvec3 w = -bounds.axis;
        Asked asked;
        asked.light = bounds.power * cosineAt(place, w);
        if (!(asked.light > 0)) return {};
        const WayToSky way = rays_.followToSky(rayTo(place, w));
        asked.arrives = way.isFree && way.panes == 0;
        return asked;
    }

    Asked askPoint(const Place& place, const LightBounds& bounds) const {
        const glm::dvec3 to = bounds.lo - place.point;
        const double distance = glm::length(to);
        if (!(distance > 0)) return {};
        const glm::dvec3 w = to / distance;
        const bool isInCone = !bounds.sharp || -glm::dot(w, bounds.axis) >= bounds.cosSpread;
        const bool fallsOff = bounds.group == gpu::LIGHT_GROUP_NEAR;
        const double square = std::max(distance * distance, bounds.reach * bounds.reach);
        Asked asked;
        asked.light = isInCone ? bounds.power * cosineAt(place, w) / (fallsOff ? square : 1) : 0;
        if (!(asked.light > 0)) return {};
        const Found found = follow(place, w);
        asked.arrives = found.panes == 0 && (!found.hit || found.hit.t >= distance);
        return asked;
    }

    const GpuScene& packed_;
    SceneRays rays_;
    std::optional<SkyPicture> sky_;
};

/// All samples of one light at a place.
struct AskedOfLight {
    uint32_t number = 0;
    std::vector<Asked> asked;

    double arriving() const {
        double sum = 0;
        for (const Asked& a : asked)
            sum += a.arrives ? a.light : 0;
        return sum / double(asked.size());
    }
};
using AskedOfPlace = std::vector<AskedOfLight>;

std::vector<AskedOfPlace> askAround(const Scene& scene, const GpuScene& packed,
                                    const Camera& camera, bool goThroughGlass) {
    Random random(41);
    const Asker asker(scene, packed, goThroughGlass);
    const uint32_t count = packed.lights.count, each = std::min(count, kLightsOfPlace);
    std::vector<AskedOfPlace> places;
    uint32_t next = 0;
    for (const Place& place : placesSeen(asker.rays(), packed, camera, kSide, random)) {
        AskedOfPlace& all = places.emplace_back();
        for (uint32_t i = 0; i < each; ++i, next = (next + 1) % count) {
            const bool isSky = next == packed.lights.ambientNumber;
            AskedOfLight& of = all.emplace_back(next);
            for (uint32_t k = 0; k < (isSky ? kRaysToSky : 1); ++k)
                of.asked.push_back(asker.ask(place, next, random));
        }
    }
    return places;
}

/// The second moment of samples of a light at a place, times the weight of what happens there.
void add(KnownLight& known, std::span<const Asked> asked, double weight) {
    const double each = weight / double(asked.size());
    for (const Asked& a : asked) {
        known.sent += each * a.light * a.light;
        known.arrived += a.arrives ? each * a.light * a.light : 0;
        known.segments += a.segments / double(asked.size());
    }
    ++known.places;
}

/// Of samples that aim at portals hardly any is lost, and all bring what the sky's light there is
/// on average: their second moment is that mean's square, which the products of two rays estimate.
void addAimed(KnownLight& known, std::span<const Asked> asked, double weight) {
    double sent = 0, arrived = 0, sentSquares = 0, arrivedSquares = 0;
    for (const Asked& a : asked) {
        const double light = a.arrives ? a.light : 0;
        sent += a.light, sentSquares += a.light * a.light;
        arrived += light, arrivedSquares += light * light;
        known.segments += a.segments / double(asked.size());
    }
    const double each = weight / double(asked.size() * (asked.size() - 1));
    known.sent += each * (sent * sent - sentSquares);
    known.arrived += each * (arrived * arrived - arrivedSquares);
    ++known.places;
}

/// Noise counts by how bright it is beside the light of the place, and of the picture.
std::vector<KnownLight> knownOf(std::span<const AskedOfPlace> places, const LightTable& lights,
                                bool aimsAtPortals) {
    std::vector<double> brightness;
    double mean = 0;
    for (const AskedOfPlace& place : places) {
        double& sum = brightness.emplace_back(0);
        for (const AskedOfLight& of : place)
            sum += of.arriving();
        mean += sum / double(places.size());
    }
    std::vector<KnownLight> known(lights.count);
    for (size_t i = 0; i < places.size() && mean > 0; ++i) {
        const double weight = std::pow(mean / (mean + brightness[i]), 2);
        for (const AskedOfLight& of : places[i]) {
            const bool aims = aimsAtPortals && of.number == lights.ambientNumber;
            (aims ? addAimed : add)(known[of.number], of.asked, weight);
        }
    }
    for (KnownLight& k : known) {
        const double count = std::max(double(k.places), 1.0);
        k.sent /= count, k.arrived /= count, k.segments /= count;
    }
    return known;
}

} // namespace

HowLightsArePicked howToPick(const Scene& scene, const GpuScene& packed, const Camera& camera,
                             bool goThroughGlass) {
    const WeighedLights& lights = *packed.lights.weighed;
    // Samples that media take are not asked for.
    if (packed.media & gpu::MEDIA_SCATTER) return {lights.plain};
    return bestPicks(lights,
                     knownOf(askAround(scene, packed, camera, goThroughGlass), packed.lights,
                             !packed.portals.all.empty()),
                     packed.lights.ambientNumber);
}

} // namespace stromboli
