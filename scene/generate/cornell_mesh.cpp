#include "scene/generate/cornell_mesh.hpp"

#include "scene/generate/gnarled_knot.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {

namespace {

constexpr double kHalf = 1000; // of the box's edge, millimetres

/// The side z = +kHalf is open.
std::vector<CornellMesh::Wall> walls() {
    std::vector<CornellMesh::Wall> walls = {
        {"floor", "white", {{-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}}},
        {"ceiling", "white", {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}},
        {"back", "white", {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}}},
        {"left", "red", {{-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}}},
        {"right", "green", {{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}},
        {"lamp",
         "lamp",
         {{-0.35, 0.99, -0.35}, {0.35, 0.99, -0.35}, {0.35, 0.99, 0.35}, {-0.35, 0.99, 0.35}}},
    };
    for (CornellMesh::Wall& wall : walls)
        for (glm::dvec3& corner : wall.corners)
            corner *= kHalf;
    return walls;
}

/// Leaning on one edge of its ring, standing on the floor.
StripMesh standingKnot(uint32_t along, uint32_t around, const std::string& surface) {
    StripMesh mesh = gnarledKnot(along, around, surface);
    const double c = std::cos(1.05), s = std::sin(1.05);
    const auto lean = [&](const glm::dvec3& p) {
        return glm::dvec3(p.x, c * p.y - s * p.z, s * p.y + c * p.z);
    };
    double lowest = 0;
    for (glm::dvec3& p : mesh.positions) {
        p = 0.62 * kHalf * lean(p);
        lowest = std::min(lowest, p.y);
    }
    for (glm::dvec3& p : mesh.positions)
        p.y += -kHalf - lowest;
    for (glm::dvec3& n : mesh.normals)
        n = lean(n);
    return mesh;
}

} // namespace

CornellMesh cornellMesh(uint32_t along, uint32_t around) {
    return {{{"white", {0.73, 0.73, 0.73}, {}},
             {"red", {0.62, 0.07, 0.06}, {}},
             {"green", {0.13, 0.44, 0.10}, {}},
             {"clay", {0.72, 0.52, 0.36}, {}},
             {"lamp", {0, 0, 0}, {12, 11, 9.5}}},
            walls(),
            standingKnot(along, around, "clay"),
            "clay",
            {}};
}

} // namespace stromboli
