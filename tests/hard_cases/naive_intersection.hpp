#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

/// Ray tests as textbooks and much code have them: the negative controls. All in float.
namespace stromboli::test::naive {

inline constexpr float kMissed = 3.402823466e38f;
/// The cut-off of a determinant below which a triangle counts as seen edge-on.
inline constexpr float kCutOff = 1e-8f;

/// Moeller and Trumbore 1997. Returns t, or kMissed. What NaN makes of its comparisons, it keeps.
inline float hitTriangle(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2,
                         const glm::vec3& origin, const glm::vec3& direction,
                         float cutOff = kCutOff) {
    const glm::vec3 e1 = v1 - v0, e2 = v2 - v0, p = glm::cross(direction, e2);
    const float determinant = glm::dot(e1, p);
    if (std::abs(determinant) < cutOff) return kMissed;
    const float inverse = 1 / determinant;
    const glm::vec3 s = origin - v0, q = glm::cross(s, e1);
    const float u = glm::dot(s, p) * inverse, v = glm::dot(direction, q) * inverse;
    if (u < 0 || u > 1 || v < 0 || u + v > 1) return kMissed;
    return glm::dot(e2, q) * inverse;
}

/// The roots of a quadratic equation, by its discriminant. The least t above tMin, or kMissed.
inline float hitSphere(const glm::vec3& center, float radius, const glm::vec3& origin,
                       const glm::vec3& direction, float tMin) {
    const glm::vec3 f = origin - center;
    const float a = glm::dot(direction, direction), b = 2 * glm::dot(f, direction);
    const float c = glm::dot(f, f) - radius * radius, discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return kMissed;
    const float root = std::sqrt(discriminant);
    const float t0 = (-b - root) / (2 * a), t1 = (-b + root) / (2 * a);
    return t0 > tMin ? t0 : t1 > tMin ? t1 : kMissed;
}

/// The slab test: without slack for rounding, and with what 0 / 0 makes of it. flatToo: boxes that
/// are left where they are entered count.
inline bool entersBox(const glm::vec3& lo, const glm::vec3& hi, const glm::vec3& origin,
                      const glm::vec3& direction, float tMax, bool flatToo = false) {
    float enter = 0, leave = tMax;
    for (int k = 0; k < 3; ++k) {
        const float inverse = 1 / direction[k];
        const float a = (lo[k] - origin[k]) * inverse, b = (hi[k] - origin[k]) * inverse;
        const float near = a < b ? a : b, far = a < b ? b : a;
        enter = enter > near ? enter : near;
        leave = leave < far ? leave : far;
    }
    return flatToo ? enter <= leave : enter < leave;
}

} // namespace stromboli::test::naive
