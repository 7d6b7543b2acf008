#pragma once

#include <glm/glm.hpp>

namespace stromboli::reference {

inline constexpr double kPi = 3.14159265358979323846;

/// Orthonormal frame with a given z axis; right-handed where that is all that is given.
struct Frame {
    glm::dvec3 x, y, z;

    /// z: unit.
    explicit Frame(const glm::dvec3& z);
    Frame(const glm::dvec3& xAxis, const glm::dvec3& yAxis, const glm::dvec3& zAxis)
        : x(xAxis), y(yAxis), z(zAxis) {}
    glm::dvec3 toWorld(const glm::dvec3& v) const { return v.x * x + v.y * y + v.z * z; }
    glm::dvec3 toLocal(const glm::dvec3& v) const {
        return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
    }
};

// u, v: independent, uniform in [0, 1). Directions are unit vectors, densities per solid angle.

/// Hemisphere z >= 0 with density z / pi (Malley's method).
glm::dvec3 cosineHemisphere(double u, double v);
/// Hemisphere z >= 0 with density 1 / (2 pi).
glm::dvec3 uniformHemisphere(double u, double v);
/// Whole sphere with density 1 / (4 pi).
glm::dvec3 uniformSphere(double u, double v);
/// Directions around z with 1 - cos <= oneMinusCosMax, density 1 / (2 pi oneMinusCosMax). In terms
/// of 1 - cos, which stays accurate for narrow cones.
glm::dvec3 uniformCone(double u, double v, double oneMinusCosMax);
/// Barycentric weights (b1, b2) of the second and third corner, uniform on the triangle's area.
glm::dvec2 uniformTriangle(double u, double v);

} // namespace stromboli::reference
