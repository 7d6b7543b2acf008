#include "scene/build/polygon.hpp"

#include "scene/build/triangulate.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::build {

void PolygonCutter::add(std::span<const Corner> polygon, MeshPart& part) {
    if (polygon.size() == 3) {
        part.push_back({polygon[0], polygon[1], polygon[2]});
        return;
    }
    if (polygon.size() < 3) {
        report_.warn("a polygon of fewer than 3 corners is left out");
        return;
    }
    points_.clear();
    for (const Corner& corner : polygon)
        points_.push_back(mesh_.positions[corner.position]);
    // Only the triangles that have such a corner are left out, by what places them.
    const auto isPoint = [](const glm::dvec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    if (!std::all_of(points_.begin(), points_.end(), isPoint)) {
        for (size_t i = 2; i < polygon.size(); ++i)
            part.push_back({polygon[0], polygon[i - 1], polygon[i]});
        return;
    }
    pieces_.clear();
    if (!triangulate(points_, pieces_))
        report_.warn("a polygon crosses itself or has no area; its triangles may overlap");
    for (const auto& [a, b, c] : pieces_)
        part.push_back({polygon[a], polygon[b], polygon[c]});
}

} // namespace stromboli::build
