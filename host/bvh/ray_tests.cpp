#include "host/bvh/ray_tests.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace stromboli {

namespace {

/// Component `axis` becomes z, and z takes its place.
glm::vec3 permute(glm::vec3 v, int axis) {
    std::swap(v[axis], v.z);
    return v;
}

float largestComponent(const glm::vec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// What rounding relative to the distance can take from the far end of an interval
/// (docs/numerics.md, "Boxes"; after Ize 2013).
constexpr float kBoxSlack = 1.0f + 0x1p-18f;

/// Below this fraction of the largest component a component of the direction is replaced, so that
/// no 0 * infinity arises.
constexpr float kLeastComponent = 0x1p-60f;

uint32_t byteOf(const std::array<uint32_t, 2>& words, uint32_t slot) {
    return words[slot / 4] >> (8 * (slot % 4)) & 255u;
}

} // namespace

PreparedRay::PreparedRay(const glm::vec3& origin_, const glm::vec3& direction_)
    : origin(origin_), direction(direction_) {
    const glm::vec3 size = glm::abs(direction);
    const float largest = largestComponent(size);
    for (int i = 0; i < 3; ++i) {
        const float component = std::max(size[i], largest * kLeastComponent);
        reciprocal[i] = 1.0f / (direction[i] < 0 ? -component : component);
    }
    octant =
        (reciprocal.x < 0 ? 0u : 1u) | (reciprocal.y < 0 ? 0u : 2u) | (reciprocal.z < 0 ? 0u : 4u);
    axis = size.z == largest ? 2 : (size.x == largest ? 0 : 1);
    const glm::vec3 d = permute(direction, axis);
    shear = {d.x / d.z, d.y / d.z, 1.0f / d.z};
}

uint32_t enterChildren(const gpu::NodeRecord& node, const PreparedRay& ray, float tMax) {
    struct Axis {
        uint32_t gridWord;
        std::array<uint32_t, 2> low, high;
    };
    const Axis axes[3] = {
        {node.originAndExponentX, {node.lowX0, node.lowX1}, {node.highX0, node.highX1}},
        {node.originAndExponentY, {node.lowY0, node.lowY1}, {node.highY0, node.highY1}},
        {node.originAndExponentZ, {node.lowZ0, node.lowZ1}, {node.highZ0, node.highZ1}}};
    uint32_t entered = 0;
    for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot) {
        // Bit patterns, as the kernel compares them: those of floats that are not negative
        // compare as the floats do, and negative ones are below them all.
        int32_t enter = 0, last = std::bit_cast<int32_t>(tMax);
        for (int i = 0; i < 3; ++i) {
            const float origin = std::bit_cast<float>(axes[i].gridWord & 0xFFFFFF00u);
            const float cell = std::bit_cast<float>((axes[i].gridWord & 255u) << 23);
            const float base = (origin - ray.origin[i]) * ray.reciprocal[i];
            const float scale = cell * ray.reciprocal[i];
            // Near and far by the direction's sign, not as the lesser and the greater of both
            // distances: the inverted box of an absent child must stay inverted.
            const bool ascending = (ray.octant >> i & 1u) != 0;
            const float nearPlane = float(byteOf(ascending ? axes[i].low : axes[i].high, slot));
            const float farPlane = float(byteOf(ascending ? axes[i].high : axes[i].low, slot));
            const float near = nearPlane * scale + (base - ray.slack[i]);
            const float far = farPlane * scale + (base + ray.slack[i]);
            enter = std::max(enter, std::bit_cast<int32_t>(near));
            last = std::min(last, std::bit_cast<int32_t>(far));
        }
        if (enter <= std::bit_cast<int32_t>(std::bit_cast<float>(last) * kBoxSlack))
            entered |= 1u << (slot ^ ray.octant);
    }
    return entered;
}

/// Why no ray passes between two triangles: a corner is translated, permuted and sheared to the
/// same bits in every triangle that has it, and an edge's function is computed from the same two
/// rounded products in both triangles of the edge, with opposite signs. Rounding is monotonic, so
/// ab < cd gives fl(ab) <= fl(cd): the sign of fl(ab) - fl(cd) is never inverted, at worst zero,
/// and zero counts as inside: of functions of one sign, that of their sum, no weight is negative;
/// where all are zero weights are NaN, which no comparison takes. Fused products would break this
/// (StromboliTargets.cmake forbids them).
std::optional<PrimitiveHit> hitTriangle(const glm::vec3& v0, const glm::vec3& v1,
                                        const glm::vec3& v2, const PreparedRay& ray) {
    const glm::vec3 a = permute(v0 - ray.origin, ray.axis);
    const glm::vec3 b = permute(v1 - ray.origin, ray.axis);
    const glm::vec3 c = permute(v2 - ray.origin, ray.axis);
    const float ax = a.x - ray.shear.x * a.z, ay = a.y - ray.shear.y * a.z;
    const float bx = b.x - ray.shear.x * b.z, by = b.y - ray.shear.y * b.z;
    const float cx = c.x - ray.shear.x * c.z, cy = c.y - ray.shear.y * c.z;
    const float u = cx * by - cy * bx;
    const float v = ax * cy - ay * cx;
    const float w = bx * ay - by * ax;
    // Weights first: the product of an edge function and a distance may overflow.
    const float inverse = 1.0f / (u + v + w);
    const float b0 = u * inverse, b1 = v * inverse, b2 = w * inverse;
    if (!(b0 >= 0 && b1 >= 0 && b2 >= 0)) return std::nullopt;
    const float t = (b0 * a.z + b1 * b.z + b2 * c.z) * ray.shear.z;
    if (!std::isfinite(t)) return std::nullopt;
    return PrimitiveHit{t, b1, b2};
}

/// The discriminant comes from the line's distance to the centre: b^2 - 4ac has no correct digit
/// left once the sphere is 4096 radii away. The perpendicular to the line is found in two steps:
/// after the first, rounding leaves a part along the line of some 2^-22 of the distance. The root
/// that would cancel comes from the product of the roots.
std::optional<PrimitiveHit> hitSphere(const glm::vec3& center, float radius, const PreparedRay& ray,
                                      float tMin, float tMax) {
    const float inverseLength2 = 1.0f / glm::dot(ray.direction, ray.direction);
    const glm::vec3 f = ray.origin - center;
    const float nearlyClosest = -glm::dot(f, ray.direction) * inverseLength2;
    const glm::vec3 nearlyPerpendicular = f + nearlyClosest * ray.direction;
    const float correction = -glm::dot(nearlyPerpendicular, ray.direction) * inverseLength2;
    const float closest = nearlyClosest + correction;
    const float distance = glm::length(nearlyPerpendicular + correction * ray.direction);
    const float discriminant = (radius - distance) * (radius + distance) * inverseLength2;
    if (!(discriminant >= 0)) return std::nullopt;
    const float q = closest + std::copysign(std::sqrt(discriminant), closest);
    const float fromOrigin = glm::length(f);
    const float product = (fromOrigin - radius) * (fromOrigin + radius) * inverseLength2;
    const float other = q != 0 ? product / q : kInfiniteDistance;
    const float t0 = std::min(q, other), t1 = std::max(q, other);
    const float t = t0 > tMin ? t0 : t1;
    if (!(t > tMin && t < tMax)) return std::nullopt;
    return PrimitiveHit{t, 0, 0};
}

} // namespace stromboli
