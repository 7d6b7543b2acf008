#include "scene/build/tubes.hpp"

#include "scene/build/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stromboli::build {
namespace {

/// The mean of the directions from and to the neighbours.
glm::dvec3 directionAt(const Strand& strand, size_t i) {
    glm::dvec3 from(0.0), to(0.0);
    if (i > 0) from = unit(strand[i].place - strand[i - 1].place).value_or(from);
    if (i + 1 < strand.size()) to = unit(strand[i + 1].place - strand[i].place).value_or(to);
    return unit(from + to).value_or(unit(to).value_or(glm::dvec3(0, 0, 1)));
}

/// How far a ring's point lies outwards, so that the tubes on both sides are as wide as `radius`
/// when they meet at an angle.
double mitred(double radius, const glm::dvec3& normal, const Strand& strand, size_t i) {
    if (i == 0 || i + 1 == strand.size()) return radius;
    const auto before = unit(strand[i].place - strand[i - 1].place);
    const double along = before ? glm::dot(normal, *before) : 0;
    constexpr double kLongestSegment = 3; // where a strand turns back
    return radius * std::min(1 / std::sqrt(std::max(1 - along * along, 1e-6)), kLongestSegment);
}

} // namespace

TubeDetail tubeDetail(size_t points) {
    if (points <= kMostDetailedPoints) return {};
    return {3, 0.5};
}

void addTube(Mesh& mesh, const Strand& strand, uint32_t sides) {
    const double turn = 2 * std::numbers::pi / sides;
    const double wider = turn / 2 / std::sin(turn / 2); // the outline is a circle's
    const auto first = uint32_t(mesh.positions.size());
    glm::dvec3 x(0.0);
    for (size_t i = 0; i < strand.size(); ++i) {
        const glm::dvec3 along = directionAt(strand, i);
        const glm::dvec3 other =
            std::abs(along.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        // Turned as little as may be from the ring before.
        x = unit(x - along * glm::dot(along, x)).value_or(glm::normalize(glm::cross(along, other)));
        const glm::dvec3 y = glm::cross(along, x);
        for (uint32_t side = 0; side < sides; ++side) {
            const glm::dvec3 normal = x * std::cos(turn * side) + y * std::sin(turn * side);
            const double radius = mitred(wider * strand[i].radius, normal, strand, i);
            mesh.positions.push_back(strand[i].place + radius * normal);
            mesh.normals.push_back(normal);
            mesh.attributes.emplace_back().uv[0] = {float(side) / float(sides),
                                                    float(i) / float(strand.size() - 1)};
        }
    }
    MeshPart& part = mesh.parts.front();
    for (uint32_t ring = 0; ring + 1 < strand.size(); ++ring)
        for (uint32_t side = 0; side < sides; ++side) {
            const auto corner = [&](uint32_t up, uint32_t around) {
                const uint32_t n = first + (ring + up) * sides + around % sides;
                return Corner{n, n, n};
            };
            part.push_back({corner(0, side), corner(0, side + 1), corner(1, side + 1)});
            part.push_back({corner(0, side), corner(1, side + 1), corner(1, side)});
        }
}

} // namespace stromboli::build
