#pragma once

#include "shaders/shared/scene_types.h"

#include <glm/glm.hpp>

#include <limits>
#include <optional>

/// Ray against box, triangle and sphere in float, as the kernel does it
/// (shaders/include/intersect.glsl).
namespace stromboli {

inline constexpr float kInfiniteDistance = std::numeric_limits<float>::infinity();

/// A ray with what its intersection tests need. Distances t are in units of the direction's
/// length, which need not be 1; its largest component should be within [2^-60, 2^60], so that
/// neither its reciprocal nor products with coordinates up to 2^60 overflow.
struct PreparedRay {
    PreparedRay(const glm::vec3& origin, const glm::vec3& direction);

    glm::vec3 origin, direction;
    glm::vec3 reciprocal;  ///< of the direction; finite (boxes)
    uint32_t octant;       ///< bit k: the direction is not negative on axis k (boxes)
    int axis;              ///< largest component of the direction (triangles)
    glm::vec3 shear;       ///< maps the permuted direction to the z axis (triangles)
    glm::vec3 slack{0.0f}; ///< by how much planes of boxes move, in distance along the ray
};

/// Which children of a node the ray enters within [0, tMax]: bit (slot ^ octant) for each, so that
/// the highest bit is the nearest child, more or less. Conservative: never misses a child whose
/// true box the exact ray touches within the interval.
uint32_t enterChildren(const gpu::NodeRecord& node, const PreparedRay& ray, float tMax);

/// Where a primitive is hit.
struct PrimitiveHit {
    float t;
    float b1, b2; ///< triangles: barycentric weights of v1 and v2; spheres: 0
};

/// Watertight (Woop, Benthin and Wald 2013): a ray through an edge or a corner that triangles
/// share hits at least one of them, on either side. t may have any sign. No hit if the triangle
/// is seen edge-on or has no area, or if the ray is not finite.
std::optional<PrimitiveHit> hitTriangle(const glm::vec3& v0, const glm::vec3& v1,
                                        const glm::vec3& v2, const PreparedRay& ray);

/// The least t in (tMin, tMax) at which the ray meets the sphere, from either side.
std::optional<PrimitiveHit> hitSphere(const glm::vec3& center, float radius, const PreparedRay& ray,
                                      float tMin, float tMax);

} // namespace stromboli
