#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// The unit vector with azimuth 2 pi v whose angle to the z axis has this cosine and sine.
glm::dvec3 spherical(double cosine, double sine, double v) {
    return {sine * std::cos(2 * kPi * v), sine * std::sin(2 * kPi * v), cosine};
}

} // namespace

Frame::Frame(const glm::dvec3& axis) : z(axis) {
    // The coordinate axis least aligned with z keeps the cross product long.
    const glm::dvec3 a = glm::abs(z);
    const glm::dvec3 other = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                             : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                      : glm::dvec3(0, 0, 1);
    x = glm::normalize(glm::cross(other, z));
    y = glm::cross(z, x);
}

glm::dvec3 cosineHemisphere(double u, double v) {
    return spherical(std::sqrt(1 - u), std::sqrt(u), v);
}

glm::dvec3 uniformHemisphere(double u, double v) {
    return uniformCone(u, v, 1);
}

glm::dvec3 uniformSphere(double u, double v) {
    return uniformCone(u, v, 2);
}

glm::dvec3 uniformCone(double u, double v, double oneMinusCosMax) {
    const double oneMinusCos = u * oneMinusCosMax;
    const double sine2 = oneMinusCos * (2 - oneMinusCos);
    return spherical(1 - oneMinusCos, std::sqrt(std::max(sine2, 0.0)), v);
}

glm::dvec2 uniformTriangle(double u, double v) {
    // A point of the square beyond the diagonal is turned by half a turn about its middle.
    return u + v <= 1 ? glm::dvec2(u, v) : glm::dvec2(1 - u, 1 - v);
}

} // namespace stromboli::reference
