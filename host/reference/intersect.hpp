#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <optional>

namespace stromboli::reference {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Unit round-off of double.
inline constexpr double kRoundoff = 0x1p-53;
inline constexpr uint32_t kNoPrimitive = 0xFFFFFFFFu;

/// Hits count for tMin < t < tMax.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0, 0, -1}; ///< unit
    double tMin = 0, tMax = kInfinity;
};

/// Where a ray meets a primitive. Triangles: the point is (1 - b1 - b2) v0 + b1 v1 + b2 v2.
struct Hit {
    double t = kInfinity;
    uint32_t primitive = kNoPrimitive; ///< triangles first, then spheres, in the scene's order
    double b1 = 0, b2 = 0;
};

/// Both sides count, edges belong to the triangle. `primitive` of the result is not set.
/// Moeller and Trumbore 1997, without a threshold for the determinant: triangles of any size can
/// be hit, and those of no area cannot.
std::optional<Hit> intersectTriangle(const Ray& ray, const glm::dvec3& v0, const glm::dvec3& v1,
                                     const glm::dvec3& v2);

/// The nearer of the two hits that lies within the ray. `primitive` of the result is not set.
std::optional<Hit> intersectSphere(const Ray& ray, const glm::dvec3& center, double radius);

} // namespace stromboli::reference
