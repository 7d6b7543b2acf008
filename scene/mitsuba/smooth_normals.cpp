#include "scene/mitsuba/smooth_normals.hpp"

#include "scene/build/vectors.hpp"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace stromboli::mitsuba {
namespace {

/// A triangle at a position.
struct Side {
    glm::dvec3 normal{0.0}; ///< unit
    double angle = 0;       ///< that it has there
    build::Corner* corner = nullptr;
};

using Place = std::tuple<double, double, double>;

std::map<Place, std::vector<Side>> sidesOf(build::Mesh& mesh) {
    std::map<Place, std::vector<Side>> sides;
    for (build::MeshPart& part : mesh.parts)
        for (build::MeshTriangle& triangle : part) {
            const auto p = [&](size_t i) { return mesh.positions[triangle[i % 3].position]; };
            const std::optional<glm::dvec3> normal =
                build::unit(glm::cross(p(1) - p(0), p(2) - p(0)));
            for (size_t i = 0; i < 3; ++i) {
                const std::optional<double> at = build::angleAt(p(i), p(i + 1), p(i + 2));
                const double angle = normal ? at.value_or(0) : 0;
                sides[{p(i).x, p(i).y, p(i).z}].push_back(
                    {normal.value_or(glm::dvec3(0)), angle, &triangle[i]});
            }
        }
    return sides;
}

} // namespace

void smoothUpTo(build::Mesh& mesh, double degrees) {
    constexpr double kChance = 1e-9; // of the cosine, of triangles in one plane
    const double least = std::cos(glm::radians(degrees)) - kChance;
    mesh.normals.clear();
    mesh.isFlat = false;
    // A fan of many triangles that each look at all others would take for ever.
    constexpr size_t kMostSides = 4096;
    for (auto& [place, sides] : sidesOf(mesh))
        for (Side& side : sides) {
            glm::dvec3 sum(0.0);
            for (size_t i = 0; i < std::min(sides.size(), kMostSides); ++i)
                if (glm::dot(sides[i].normal, side.normal) >= least)
                    sum += sides[i].normal * sides[i].angle;
            side.corner->normal = uint32_t(mesh.normals.size());
            mesh.normals.push_back(build::unit(sum).value_or(side.normal));
        }
}

} // namespace stromboli::mitsuba
