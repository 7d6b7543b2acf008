#include "scene/build/triangulate.hpp"

#include "scene/build/ear_clipper.hpp"
#include "scene/build/orientation.hpp"

#include <cmath>

namespace stromboli::build {
namespace {

/// Normal by Newell's sum; its length is twice the area.
glm::dvec3 polygonNormal(std::span<const glm::dvec3> polygon) {
    glm::dvec3 sum(0);
    for (size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    return sum;
}

/// The polygon with one coordinate left out, counter-clockwise; a subset of the coordinates, so
/// that nothing is rounded.
std::vector<glm::dvec2> project(std::span<const glm::dvec3> polygon) {
    const glm::dvec3 normal = polygonNormal(polygon), size = glm::abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    int first = (dropped + 1) % 3, second = (dropped + 2) % 3;
    if (normal[dropped] < 0) std::swap(first, second);
    std::vector<glm::dvec2> flat;
    flat.reserve(polygon.size());
    for (const glm::dvec3& p : polygon)
        flat.emplace_back(p[first], p[second]);
    return flat;
}

/// True if every corner turns left and every triangle of the fan about corner 0 does too.
bool isConvex(std::span<const glm::dvec2> polygon) {
    const size_t n = polygon.size();
    for (size_t i = 0; i < n; ++i) {
        const glm::dvec2 &here = polygon[i], &next = polygon[(i + 1) % n];
        if (!(orientation(here, next, polygon[(i + 2) % n]) > 0)) return false;
        if (i > 0 && i + 1 < n && !(orientation(polygon[0], here, next) > 0)) return false;
    }
    return true;
}

} // namespace

bool triangulate(std::span<const glm::dvec3> polygon,
                 std::vector<std::array<uint32_t, 3>>& triangles) {
    const auto n = uint32_t(polygon.size());
    if (n == 3) {
        triangles.push_back({0, 1, 2});
        return true;
    }
    const std::vector<glm::dvec2> flat = project(polygon);
    if (!isConvex(flat)) return EarClipper(flat).run(triangles);
    for (uint32_t i = 1; i + 1 < n; ++i)
        triangles.push_back({0, i, i + 1});
    return true;
}

} // namespace stromboli::build
