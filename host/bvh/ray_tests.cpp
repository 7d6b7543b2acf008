#include "host/bvh/ray_tests.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {

namespace {

/// Woop's permutation: component `axis` becomes z. Cyclic, so that orientation is kept.
glm::vec3 permute(const glm::vec3& v, int axis) {
    if (axis == 2) return v;
    return axis == 0 ? glm::vec3(v.y, v.z, v.x) : glm::vec3(v.z, v.x, v.y);
}

float largestComponent(const glm::vec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// Both ends of an interval carry three roundings here: lo - origin, the reciprocal and the
/// product, 6 units of 2^-24 together. On the GPU, with a division of 2.5 ulp, 14 units. Moving
/// the far end by 2^-20 (16 units; a rounding of its own included) makes up for either
/// (after Ize 2013, "Robust BVH Ray Traversal").
constexpr float kFarSlack = 1.0f + 0x1p-20f;

/// Below this fraction of the largest component a component of the direction is replaced, so that
/// no 0 * infinity arises. The ray moves by 2^-40 of its length: far below the rounding of its
/// coordinates.
constexpr float kLeastComponent = 0x1p-40f;

} // namespace

PreparedRay::PreparedRay(const glm::vec3& origin_, const glm::vec3& direction_)
    : origin(origin_), direction(direction_) {
    const glm::vec3 size = glm::abs(direction);
    const float largest = largestComponent(size);
    for (int i = 0; i < 3; ++i) {
        const float component = std::max(size[i], largest * kLeastComponent);
        reciprocal[i] = 1.0f / (direction[i] < 0 ? -component : component);
    }
    axis = size.z == largest ? 2 : (size.x == largest ? 0 : 1);
    const glm::vec3 d = permute(direction, axis);
    shear = {d.x / d.z, d.y / d.z, 1.0f / d.z};
}

std::optional<float> enterBox(const glm::vec3& lo, const glm::vec3& hi, const PreparedRay& ray,
                              float tMax) {
    float tNear = 0, tFar = tMax;
    for (int i = 0; i < 3; ++i) {
        // The nearer plane by the direction's sign, not as the lesser of both distances: an
        // inverted box must stay inverted.
        const bool descending = ray.reciprocal[i] < 0;
        tNear = std::max(tNear, ((descending ? hi : lo)[i] - ray.origin[i]) * ray.reciprocal[i]);
        tFar = std::min(tFar, ((descending ? lo : hi)[i] - ray.origin[i]) * ray.reciprocal[i]);
    }
    if (tNear <= tFar * kFarSlack) return tNear;
    return std::nullopt;
}

/// Why no ray passes between two triangles: a corner is translated, permuted and sheared to the
/// same bits in every triangle that has it, and an edge's function is computed from the same two
/// rounded products in both triangles of the edge, with opposite signs. Rounding is monotonic, so
/// ab < cd gives fl(ab) <= fl(cd): the sign of fl(ab) - fl(cd) is never inverted, at worst zero,
/// and zero counts as inside. Fused products would break this (StromboliTargets.cmake forbids
/// them).
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
    const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    const float determinant = u + v + w;
    if (!inside || determinant == 0) return std::nullopt;
    const float inverse = 1.0f / determinant;
    const float t = (u * a.z + v * b.z + w * c.z) * ray.shear.z * inverse;
    if (!std::isfinite(t)) return std::nullopt;
    return PrimitiveHit{t, v * inverse, w * inverse};
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

std::optional<PrimitiveHit> hitPrimitive(const gpu::Primitive& primitive, const PreparedRay& ray,
                                         float tMin, float tMax) {
    if (primitive.kind == gpu::PRIMITIVE_SPHERE)
        return hitSphere(primitive.v0, primitive.v1.x, ray, tMin, tMax);
    const auto hit = hitTriangle(primitive.v0, primitive.v1, primitive.v2, ray);
    if (hit && hit->t > tMin && hit->t < tMax) return hit;
    return std::nullopt;
}

} // namespace stromboli
