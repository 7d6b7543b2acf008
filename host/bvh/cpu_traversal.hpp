#pragma once

#include "host/bvh/wide_layout.hpp"
#include "shaders/shared/scene_types.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

namespace stromboli {

// --- Tests of a ray ------------------------------------------------------------------------------

// Ray against box, triangle and sphere in float, as the kernel does it
// (shaders/include/intersect.glsl).

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

// --- Traversal -----------------------------------------------------------------------------------

/// The part of origin + t direction with t in the open interval (tMin, tMax); tMin >= 0. The
/// direction need not be of unit length.
struct TraversalRay {
    glm::vec3 origin{0.0f};
    glm::vec3 direction{0, 0, 1};
    float tMin = 0;
    float tMax = kInfiniteDistance;
    uint32_t skipPrimitive = gpu::NO_PRIMITIVE; ///< place of the triangle the ray starts on
};

struct TraversalHit {
    uint32_t primitive = gpu::NO_PRIMITIVE; ///< 2 * record + slot; NO_PRIMITIVE: nothing hit
    float t = kInfiniteDistance;
    float b1 = 0, b2 = 0;                   ///< triangles: barycentric weights of v1 and v2
    uint32_t placement = gpu::NO_PLACEMENT; ///< record of the placement that the triangle is in

    explicit operator bool() const { return primitive != gpu::NO_PRIMITIVE; }
};

/// What a traversal did.
struct TraversalCounts {
    uint32_t nodes = 0, leaves = 0; ///< records visited
    uint32_t spheres = 0;           ///< of these leaves
    uint32_t mostWaiting = 0;       ///< stack entries in use at once
};

/// The hit with the least t, in prototypes too; which one, where several primitives are hit at the
/// same t, depends on the tree. A ray whose origin, direction or interval has a part that is NaN, a
/// direction of 0 or infinite parts hits nothing. Scalar float: a double of the kernel for tests
/// and tools (shaders/include/traverse.glsl).
TraversalHit closestHit(const WideLayout& layout, const TraversalRay& ray,
                        TraversalCounts* counts = nullptr);

/// The corners of the triangle that was hit, in the world, in the order that its barycentric
/// weights have; nothing of spheres.
std::optional<std::array<glm::vec3, 3>> cornersAt(const WideLayout& layout,
                                                  const TraversalHit& hit);

/// Whether anything is hit: whether a segment is blocked.
bool anyHit(const WideLayout& layout, const TraversalRay& ray, TraversalCounts* counts = nullptr);

} // namespace stromboli
