#pragma once

#include <glm/glm.hpp>

#include <array>
#include <optional>

namespace stromboli {

/// Where a ray meets a triangle, on either side: at the weights 1 - b1 - b2, b1 and b2 of its
/// corners.
struct TriangleMeeting {
    double t = 0; ///< origin + t direction, of either sign
    double b1 = 0, b2 = 0;
    bool fromFront = true; ///< against the normal, (corner 1 - corner 0) x (corner 2 - corner 0)
};

/// Closed meshes have no gaps: a ray through an edge, or a corner, that triangles share meets
/// exactly one of those that lie around it, as seen along the ray, whatever is rounded (Woop,
/// Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013, with exact signs and
/// a rule of who owns an edge). direction: of any length.
std::optional<TriangleMeeting> meetTriangle(const glm::dvec3& origin, const glm::dvec3& direction,
                                            const std::array<glm::dvec3, 3>& corners);

} // namespace stromboli
