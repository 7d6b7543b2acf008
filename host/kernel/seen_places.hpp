#pragma once

#include "host/bvh/cpu_traversal.hpp"
#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "scene/camera/camera.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace stromboli {

// Places where a picture takes light samples, and rays from them, by which the host chooses how a
// kernel samples. Nothing that a picture shows follows from them but its noise.

/// What a ray has found: its closest hit, or the first one behind glass.
struct Found {
    TraversalRay ray; ///< the last of its segments
    TraversalHit hit;
    int panes = 0; ///< surfaces of glass on its way

    /// The last segment has the direction of the first one, but for rounding (SAME_DIRECTION).
    bool keepsDirection(const glm::vec3& first) const;
};

/// What has become of a ray to what is infinitely far.
struct WayToSky {
    bool isFree = false; ///< nothing stops it, nor turns it aside
    int panes = 0;       ///< as Found has it
};

/// Rays through a scene. Refers to both of its forms.
class SceneRays {
  public:
    /// goThroughGlass: as light samples do (LIGHT_THROUGH_GLASS).
    SceneRays(const Scene& scene, const GpuScene& packed, bool goThroughGlass);

    /// Follows a ray through clear glass, bent, as far as that lets it through.
    Found follow(const TraversalRay& ray) const;
    /// Before that it goes straight through what may be partly not there: leaves that are cut out,
    /// veils, borders of media. How much of them is there is not looked up, so that more is found
    /// than arrives.
    Found followToLight(const TraversalRay& ray) const;
    /// The same for a ray to what is infinitely far, of which only that is asked: where nothing
    /// lets rays through, the first hit of any ends it.
    WayToSky followToSky(const TraversalRay& ray) const;

    bool isClear(const TraversalHit& hit) const;
    bool emits(const TraversalHit& hit) const;
    /// Unit, as stored.
    glm::dvec3 normalAt(const TraversalRay& ray, const TraversalHit& hit) const;
    static glm::dvec3 pointAt(const TraversalRay& ray, const TraversalHit& hit);
    /// From a surface, whose side n points to, in direction d.
    TraversalRay leave(const glm::dvec3& point, const glm::dvec3& n, const glm::dvec3& d,
                       const TraversalHit& hit) const;

  private:
    Found throughGlass(Found found) const;
    bool mayBeNotThere(const TraversalHit& hit) const;
    double indexAt(const TraversalHit& hit) const;
    std::optional<TraversalRay> throughSurface(const TraversalRay& ray,
                                               const TraversalHit& hit) const;

    const Scene& scene_;
    const GpuScene& packed_;
    bool goThroughGlass_;
    bool someIsNotThere_; ///< a surface may be (mayBeNotThere())
};

/// A point of a surface that scatters light into many directions.
struct Place {
    glm::dvec3 point, normal; ///< unit, to where it is seen from
    TraversalHit hit;
    bool isLitFromBehind = false; ///< it scatters what falls on its other side, too
};

/// What the camera sees, by side x side rays, and `bounces` times a place that is seen from each of
/// the places before.
std::vector<Place> placesSeen(const SceneRays& rays, const GpuScene& packed, const Camera& camera,
                              uint32_t side, Random& random, int bounces = 1);

} // namespace stromboli
