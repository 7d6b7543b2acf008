#pragma once

#include "host/reference/random.hpp"
#include "host/reference/surface.hpp"

namespace stromboli::reference {

/// A sampled bounce.
struct BsdfSample {
    glm::dvec3 direction{0.0}; ///< unit, world space, away from the surface
    glm::dvec3 weight{0.0};    ///< f |cos| / pdf (solid angle); 0 ends the path
    bool transmitted = false;  ///< to the other side of the surface
};

/// f(wo, wi) |cos(wi, shading normal)| for a unit world direction wi away from the surface; 0 for
/// delta materials. The surface is faced forward.
glm::dvec3 evaluateBsdf(const SurfacePoint& surface, const glm::dvec3& wi, Convention convention);

/// Samples the direction of the next bounce. The surface is faced forward.
BsdfSample sampleBsdf(const SurfacePoint& surface, RandomStream& random, Convention convention);

} // namespace stromboli::reference
