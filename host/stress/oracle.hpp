#pragma once

#include "host/core/random.hpp"
#include "host/stress/case.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stromboli::stress {

// --- The oracle ----------------------------------------------------------------------------------

/// Where a ray's line meets a primitive's surface, in double precision.
struct Crossing {
    double t = 0; ///< in lengths of the direction
    /// How far within the primitive's outline, as seen along the ray; negative: outside, and no
    /// hit. Rays nearer to it than float coordinates are rounded may count either way.
    double margin = -1;
    double cosine = 0; ///< between the ray and the normal; its rounding moves t by 1 / cosine
};

/// By the plane's equation and areas, which shares nothing with the kernel's test.
Crossing crossTriangle(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2,
                       const Ray& ray);

/// Whether `found` (or kMissed) is the distance of the ray's closest hit in the scene, found by
/// trying every primitive, as far as can be said: coordinates carry `error` across the ray.
bool isClosestHit(const Scene& scene, const Ray& ray, float found, double error);

// --- Rays drawn at random ------------------------------------------------------------------------

/// So many rays, the same on any number of threads. draw(random, i) makes the one of this number.
std::vector<Ray> drawnRays(uint64_t count, uint32_t seed,
                           const std::function<Ray(Random&, uint64_t)>& draw);

/// A ray from there to there and beyond, its direction a unit vector every other time.
Ray rayTowards(const glm::vec3& origin, const glm::vec3& target, uint64_t number);

/// Traces so many rays, in batches that ask in turn for any hit and for the nearest, and adds to
/// the finding how many hit nothing. draw(n) makes n of them; where: said of them if one missed.
void countMisses(Run& run, RayTracer& tracer, uint64_t rays,
                 const std::function<std::vector<Ray>(uint64_t)>& draw, const std::string& where,
                 Finding& f);

} // namespace stromboli::stress
