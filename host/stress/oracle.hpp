#pragma once

#include "host/stress/subject.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::stress {

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

} // namespace stromboli::stress
