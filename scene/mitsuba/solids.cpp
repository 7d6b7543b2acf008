#include "scene/mitsuba/solids.hpp"

#include "scene/build/surface_mesh.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace stromboli::mitsuba {
namespace {

constexpr double kPi = std::numbers::pi;

/// Around the z axis; exactly where the sides begin and end.
glm::dvec2 direction(double share) {
    const double turn = share >= 1 ? 0 : share;
    return {std::cos(2 * kPi * turn), std::sin(2 * kPi * turn)};
}

/// Where the texture coordinates about an axis begin in Mitsuba 3: Duff et al., "Building an
/// Orthonormal Basis, Revisited" (JCGT 2017).
glm::dvec3 across(const glm::dvec3& axis) {
    const double sign = std::copysign(1, axis.z), a = -1 / (sign + axis.z);
    return {1 + sign * axis.x * axis.x * a, sign * axis.x * axis.y * a, -sign * axis.x};
}

/// Where they begin in Mitsuba 0.x: across a second axis without the smaller one of x and y.
glm::dvec3 oldAcross(const glm::dvec3& axis) {
    const bool isAlongX = std::abs(axis.x) > std::abs(axis.y);
    const glm::dvec3 second =
        isAlongX ? glm::dvec3(axis.z, 0, -axis.x) : glm::dvec3(0, axis.z, -axis.y);
    return glm::cross(glm::normalize(second), axis);
}

} // namespace

build::Mesh rectangleMesh() {
    build::Mesh mesh = build::gridMesh(1, 1, [](double s, double t) {
        return build::SurfacePoint{{2 * s - 1, 2 * t - 1, 0}, {0, 0, 1}, {s, t}};
    });
    build::makeFlat(mesh);
    return mesh;
}

build::Mesh cubeMesh() {
    // Where Mitsuba has the texture coordinates (0, 0), (1, 0) and (0, 1) of each face.
    using Corners = std::array<glm::dvec3, 3>;
    constexpr std::array<Corners, 6> kFaces = {{{{{-1, -1, -1}, {-1, -1, 1}, {1, -1, -1}}},
                                                {{{1, 1, 1}, {-1, 1, 1}, {1, 1, -1}}},
                                                {{{1, -1, 1}, {1, 1, 1}, {1, -1, -1}}},
                                                {{{-1, -1, 1}, {-1, 1, 1}, {1, -1, 1}}},
                                                {{{-1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}},
                                                {{{-1, 1, -1}, {-1, -1, -1}, {1, 1, -1}}}}};
    build::Mesh cube;
    cube.parts.emplace_back();
    for (const Corners& c : kFaces) {
        // Seen from outside u, v run clockwise.
        const build::Mesh face = build::gridMesh(1, 1, [&](double v, double u) {
            return build::SurfacePoint{c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]), {}, {u, v}};
        });
        const auto first = uint32_t(cube.positions.size());
        cube.positions.insert(cube.positions.end(), face.positions.begin(), face.positions.end());
        cube.attributes.insert(cube.attributes.end(), face.attributes.begin(),
                               face.attributes.end());
        for (build::MeshTriangle triangle : face.parts.front()) {
            for (build::Corner& corner : triangle)
                corner = {corner.position + first, kNoNormals, corner.attributes + first};
            cube.parts.front().push_back(triangle);
        }
    }
    cube.isFlat = true;
    return cube;
}

build::Mesh diskMesh() {
    build::Mesh mesh = build::gridMesh(1, kSides, [](double s, double t) {
        return build::SurfacePoint{{s * direction(t), 0}, {0, 0, 1}, {s, t}};
    });
    build::makeFlat(mesh);
    return mesh;
}

build::Mesh cylinderMesh(const glm::dvec3& from, const glm::dvec3& to, double radius, bool isOld) {
    const glm::dvec3 axis = glm::normalize(to - from);
    const glm::dvec3 x = isOld ? oldAcross(axis) : across(axis);
    const glm::dvec3 y = glm::cross(axis, x);
    return build::gridMesh(kSides, 1, [&](double s, double t) {
        const glm::dvec2 d = direction(s);
        const glm::dvec3 normal = x * d.x + y * d.y;
        return build::SurfacePoint{glm::mix(from, to, t) + radius * normal, normal, {s, t}};
    });
}

} // namespace stromboli::mitsuba
