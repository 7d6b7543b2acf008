#pragma once

#include "host/bvh/binary_layout.hpp"
#include "host/bvh/ray_tests.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace stromboli {

/// The part of origin + t direction with t in the open interval (tMin, tMax); tMin >= 0. The
/// direction need not be of unit length.
struct TraversalRay {
    glm::vec3 origin{0.0f};
    glm::vec3 direction{0, 0, 1};
    float tMin = 0;
    float tMax = kInfiniteDistance;
    uint32_t skipPrimitive = gpu::NO_PRIMITIVE; ///< the planar primitive the ray starts on
};

struct TraversalHit {
    uint32_t primitive = gpu::NO_PRIMITIVE; ///< in kernel order; NO_PRIMITIVE: nothing hit
    float t = kInfiniteDistance;
    float b1 = 0, b2 = 0; ///< triangles: barycentric weights of v1 and v2

    explicit operator bool() const { return primitive != gpu::NO_PRIMITIVE; }
};

/// The hit with the least t; which one, where several primitives are hit at the same t, depends
/// on the tree. `primitives` are the scene's in the order of layout.primitiveOrder. A ray whose
/// origin, direction or interval has a part that is NaN, a direction of 0 or infinite parts
/// hits nothing. Scalar float: a double of the kernel for tests and tools.
TraversalHit closestHit(const BinaryLayout& layout, std::span<const gpu::Primitive> primitives,
                        const TraversalRay& ray);

/// Whether anything is hit: whether a segment is blocked.
bool anyHit(const BinaryLayout& layout, std::span<const gpu::Primitive> primitives,
            const TraversalRay& ray);

} // namespace stromboli
