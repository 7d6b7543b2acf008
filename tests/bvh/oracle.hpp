#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::test {

/// Where a line meets the plane of a triangle, in double: differences of the float input are
/// exact or nearly so, and nothing below cares for less than 1e-12.
struct TriangleTruth {
    double t = 0;
    glm::dvec3 weights{-1.0}; ///< barycentric; all positive: the line passes through the inside
    /// How far inside the line passes, in the plane perpendicular to it: distance to the nearest
    /// edge, negative outside.
    double margin = -1;
};

/// Plane equations and areas; shares nothing with Woop's test.
inline TriangleTruth intersectInDouble(const glm::vec3& v0, const glm::vec3& v1,
                                       const glm::vec3& v2, const glm::vec3& origin,
                                       const glm::vec3& direction) {
    const glm::dvec3 o(origin), d(direction), axis = glm::normalize(d);
    const glm::dvec3 corner[3] = {glm::dvec3(v0) - o, glm::dvec3(v1) - o, glm::dvec3(v2) - o};
    const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    TriangleTruth truth;
    const double slope = glm::dot(normal, d);
    if (slope == 0) return truth;
    truth.t = glm::dot(normal, corner[0]) / slope;
    const double side = slope > 0 ? 1 : -1;
    truth.margin = 1e300;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 a = corner[(i + 1) % 3], b = corner[(i + 2) % 3];
        const double area = glm::dot(glm::cross(a, b), d); // of the edge and the line's foot
        truth.weights[i] = area / slope;
        const double edgeLength = glm::length(glm::cross(b - a, axis));
        truth.margin = std::min(truth.margin, side * area / glm::length(d) / edgeLength);
    }
    return truth;
}

} // namespace stromboli::test
