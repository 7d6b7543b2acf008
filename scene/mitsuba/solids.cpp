#include "scene/mitsuba/solids.hpp"

#include "scene/build/surface_mesh.hpp"

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

} // namespace

build::Mesh rectangleMesh() {
    build::Mesh mesh = build::gridMesh(1, 1, [](double s, double t) {
        return build::SurfacePoint{{2 * s - 1, 2 * t - 1, 0}, {0, 0, 1}, {s, t}};
    });
    build::makeFlat(mesh);
    return mesh;
}

build::Mesh cubeMesh() {
    build::Mesh cube;
    cube.parts.emplace_back();
    for (const int axis : {0, 1, 2})
        for (const double side : {-1.0, 1.0}) {
            const build::Mesh face = build::gridMesh(1, 1, [&](double s, double t) {
                build::SurfacePoint v;
                v.position[axis] = side;
                v.position[(axis + 1) % 3] = side * (2 * s - 1);
                v.position[(axis + 2) % 3] = 2 * t - 1;
                v.uv = {s, t};
                return v;
            });
            const auto first = uint32_t(cube.positions.size());
            cube.positions.insert(cube.positions.end(), face.positions.begin(),
                                  face.positions.end());
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

build::Mesh cylinderMesh(const glm::dvec3& from, const glm::dvec3& to, double radius) {
    const glm::dvec3 axis = glm::normalize(to - from);
    const glm::dvec3 across = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(across - axis * glm::dot(axis, across));
    const glm::dvec3 y = glm::cross(axis, x);
    return build::gridMesh(kSides, 1, [&](double s, double t) {
        const glm::dvec2 d = direction(s);
        const glm::dvec3 normal = x * d.x + y * d.y;
        return build::SurfacePoint{glm::mix(from, to, t) + radius * normal, normal, {s, t}};
    });
}

} // namespace stromboli::mitsuba
