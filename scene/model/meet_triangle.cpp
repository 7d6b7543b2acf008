#include "scene/model/meet_triangle.hpp"

#include <cmath>
#include <cstddef>

namespace stromboli {
namespace {

/// a.x b.y - a.y b.x: its sign is the exact one, since products are rounded in order, and where
/// they are rounded to one number their errors tell.
double exactlySignedCross(const glm::dvec2& a, const glm::dvec2& b) {
    const double first = a.x * b.y, second = a.y * b.x;
    if (first != second) return first - second;
    return std::fma(a.x, b.y, -first) - std::fma(a.y, b.x, -second);
}

/// Of the two triangles on both sides of an edge that goes through the ray, the one that goes
/// around it counterclockwise along it owns it if the edge goes up there: so do all points that
/// lie a little to one side of the ray.
bool goesUp(const glm::dvec2& from, const glm::dvec2& to) {
    return to.y > from.y || (to.y == from.y && to.x > from.x);
}

} // namespace

std::optional<TriangleMeeting> meetTriangle(const glm::dvec3& origin, const glm::dvec3& direction,
                                            const std::array<glm::dvec3, 3>& corners) {
    // Sheared so that the ray is an axis: each corner is rounded once, alike for all triangles that
    // have it, and from there on nothing is.
    const glm::dvec3 size = glm::abs(direction);
    const int z = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    if (!(size[z] > 0)) return std::nullopt;
    const double slopeX = direction[x] / direction[z], slopeY = direction[y] / direction[z];
    std::array<glm::dvec2, 3> across;
    std::array<double, 3> along;
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec3 d = corners[i] - origin;
        across[i] = {d[x] - slopeX * d[z], d[y] - slopeY * d[z]};
        along[i] = d[z] / direction[z];
    }

    std::array<double, 3> weight; // twice the area between the ray and the edge across of a corner
    bool anyAbove = false, anyBelow = false;
    for (size_t i = 0; i < 3; ++i) {
        weight[i] = exactlySignedCross(across[(i + 1) % 3], across[(i + 2) % 3]);
        anyAbove = anyAbove || weight[i] > 0;
        anyBelow = anyBelow || weight[i] < 0;
    }
    if (anyAbove == anyBelow) return std::nullopt; // beside the ray, or seen from its edge
    for (size_t i = 0; i < 3; ++i)
        if (weight[i] == 0 && goesUp(across[(i + 1) % 3], across[(i + 2) % 3]) != anyAbove)
            return std::nullopt;

    const double sum = weight[0] + weight[1] + weight[2];
    TriangleMeeting met;
    met.b1 = weight[1] / sum;
    met.b2 = weight[2] / sum;
    met.t = weight[0] / sum * along[0] + met.b1 * along[1] + met.b2 * along[2];
    met.fromFront = anyAbove != (direction[z] > 0);
    return met;
}

} // namespace stromboli
