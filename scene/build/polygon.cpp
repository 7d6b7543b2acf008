#include "scene/build/polygon.hpp"

#include "scene/build/triangulate.hpp"

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
    pieces_.clear();
    if (!triangulate(points_, pieces_))
        report_.warn("a polygon crosses itself or has no area; its triangles may overlap");
    for (const auto& [a, b, c] : pieces_)
        part.push_back({polygon[a], polygon[b], polygon[c]});
}

} // namespace stromboli::build
