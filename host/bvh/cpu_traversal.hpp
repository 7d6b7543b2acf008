#pragma once

#include "host/bvh/ray_tests.hpp"
#include "host/bvh/wide_layout.hpp"

#include <glm/glm.hpp>

#include <cstdint>

namespace stromboli {

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
    uint32_t mostWaiting = 0;       ///< stack entries in use at once
};

/// The hit with the least t, in prototypes too; which one, where several primitives are hit at the
/// same t, depends on the tree. A ray whose origin, direction or interval has a part that is NaN, a
/// direction of 0 or infinite parts hits nothing. Scalar float: a double of the kernel for tests
/// and tools (shaders/include/traverse.glsl).
TraversalHit closestHit(const WideLayout& layout, const TraversalRay& ray,
                        TraversalCounts* counts = nullptr);

/// Whether anything is hit: whether a segment is blocked.
bool anyHit(const WideLayout& layout, const TraversalRay& ray, TraversalCounts* counts = nullptr);

} // namespace stromboli
