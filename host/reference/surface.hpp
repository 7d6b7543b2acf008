#pragma once

#include "host/reference/intersect.hpp"
#include "scene/model/scene.hpp"

namespace stromboli::reference {

/// Whose rules of shading apply (docs/estimator.md, "CS184 mode").
enum class Convention { Physical, Cs184 };

/// What the path needs to know of the point it hit.
struct SurfacePoint {
    glm::dvec3 position{0.0};
    /// Bound of the distance between `position` and the plane or sphere it lies on, for that
    /// surface and all that coincide with it.
    double error = 0;
    glm::dvec3 geometric{0, 0, 1}; ///< unit; as stored, see faceForward()
    glm::dvec3 shading{0, 0, 1};   ///< unit; interpolated, or the geometric one
    glm::dvec3 wo{0, 0, 1};        ///< unit, back along the ray
    bool outside = true;           ///< wo is on the side the stored geometric normal points to
    uint32_t primitive = kNoPrimitive;
    uint32_t triangle = kNoPrimitive; ///< the primitive if it is planar: rays that leave it miss it
    const Material* material = nullptr;
};

/// Normals as the scene states them. The hit is one of the scene's.
SurfacePoint surfaceAt(const Scene& scene, const Ray& ray, const Hit& hit);

/// Turns the geometric normal to the side of wo and the shading normal to that of the geometric
/// one; where wo is then below the shading normal's horizon, the geometric one takes its place.
/// Does nothing under the CS184 convention.
void faceForward(SurfacePoint& surface, Convention convention);

/// The point moved by its error bound along n (unit) to the side of `direction`, so that nothing
/// that coincides with the surface lies ahead of a ray from there in that direction.
glm::dvec3 moveOff(const glm::dvec3& position, double error, const glm::dvec3& n,
                   const glm::dvec3& direction);

/// Radiance the surface emits towards wo.
glm::dvec3 emission(const SurfacePoint& surface, Convention convention);

/// Error bound of a point computed on the triangle with these corners: see SurfacePoint::error.
double errorOnTriangle(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2);
/// The same for a point computed as center + radius * unit vector.
double errorOnSphere(const glm::dvec3& center, double radius);

/// Unit, on the side from which the corners are counter-clockwise.
glm::dvec3 triangleNormal(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2);

} // namespace stromboli::reference
