#include "host/reference/intersect.hpp"

#include <cmath>
#include <utility>

namespace stromboli::reference {

std::optional<Hit> intersectTriangle(const Ray& ray, const glm::dvec3& v0, const glm::dvec3& v1,
                                     const glm::dvec3& v2) {
    const glm::dvec3 e1 = v1 - v0, e2 = v2 - v0;
    const glm::dvec3 p = glm::cross(ray.direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0) return std::nullopt;

    const glm::dvec3 s = ray.origin - v0;
    const double b1 = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, e1);
    const double b2 = glm::dot(ray.direction, q) / determinant;
    // Written so that NaN, from triangles of almost no area, misses.
    if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)) return std::nullopt;

    const double t = glm::dot(e2, q) / determinant;
    if (!(t > ray.tMin && t < ray.tMax)) return std::nullopt;
    return Hit{t, kNoPrimitive, b1, b2};
}

std::optional<Hit> intersectSphere(const Ray& ray, const glm::dvec3& center, double radius) {
    const glm::dvec3 f = center - ray.origin;
    const double along = glm::dot(f, ray.direction);
    // From the distance between line and centre: b^2 - 4ac would cancel for far spheres
    // (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems).
    const glm::dvec3 across = f - along * ray.direction;
    const double discriminant = radius * radius - glm::dot(across, across);
    if (discriminant < 0) return std::nullopt;

    const double root = std::sqrt(discriminant);
    const double q = along >= 0 ? along + root : along - root;
    if (q == 0) return std::nullopt; // touches the sphere at the origin of the ray
    double near = (glm::dot(f, f) - radius * radius) / q, far = q;
    if (near > far) std::swap(near, far);
    for (const double t : {near, far})
        if (t > ray.tMin && t < ray.tMax) return Hit{t, kNoPrimitive, 0, 0};
    return std::nullopt;
}

} // namespace stromboli::reference
