#pragma once

#include "host/reference/lights.hpp"

namespace stromboli::reference {

/// A triangle of a mesh that emits.
struct EmitterTriangle {
    glm::dvec3 v0, v1, v2;
    double area; ///< of one side
    uint32_t index;
    const Scene* scene;

    EmitterTriangle(const Scene& scene, uint32_t index);
    /// What it sends out at a point of it, on a side that emits: its texture and its opacity count.
    glm::dvec3 emissionAt(const glm::dvec3& point) const;
};

// Samples of one emitter each, from a surface at `from`.

/// Uniform by direction: density `probability`, that of picking this triangle, over its solid
/// angle. Nothing from a surface in the triangle's plane, whose distance is rounding.
LightSample sampleTriangle(const EmitterTriangle& triangle, double probability,
                           const Material& material, const SurfacePoint& surface,
                           RandomStream& random);

/// Steradians that the triangle takes up as seen from a point; 0 in its plane.
double solidAngle(const EmitterTriangle& triangle, const glm::dvec3& from);

/// From outside uniform in the cone the sphere subtends (Shirley, Wang and Zimmerman 1996), from
/// inside uniform on its area. A surface point on the sphere itself is on the side wo is on.
LightSample sampleSphere(const Scene& scene, const Emitter& emitter, const SurfacePoint& surface,
                         RandomStream& random);

/// Uniform on the rectangle, falling off with the distance or its square; only the side that the
/// light's direction points to emits.
LightSample sampleRectangle(const Light& light, const glm::dvec3& from,
                            const ShadingConventions& conventions, RandomStream& random);

} // namespace stromboli::reference
