#include "scene/mitsuba/solids.hpp"

#include "scene/build/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>

namespace stromboli::mitsuba {
namespace {

constexpr double kPi = std::numbers::pi;

struct Vertex {
    glm::dvec3 position{0.0}, normal{0.0};
    glm::dvec2 uv{0.0};
};

/// A grid of columns x rows quadrangles over a surface given by (s, t) in [0, 1]^2, whose normal is
/// on the side from which s, t run counter-clockwise.
build::Mesh grid(uint32_t columns, uint32_t rows, const std::function<Vertex(double, double)>& at) {
    build::Mesh mesh;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column) {
            const Vertex v = at(double(column) / columns, double(row) / rows);
            mesh.positions.push_back(v.position);
            mesh.normals.push_back(v.normal);
            mesh.attributes.emplace_back().uv[0] = v.uv;
        }
    build::MeshPart& part = mesh.parts.emplace_back();
    const auto corner = [&](uint32_t column, uint32_t row) {
        const uint32_t number = row * (columns + 1) + column;
        return build::Corner{number, number, number};
    };
    const auto add = [&](const build::Corner& a, const build::Corner& b, const build::Corner& c) {
        // At poles a side of the quadrangle is a point.
        const auto p = [&](const build::Corner& k) { return mesh.positions[k.position]; };
        if (glm::length(glm::cross(p(b) - p(a), p(c) - p(a))) > 0) part.push_back({a, b, c});
    };
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const build::Corner a = corner(column, row), b = corner(column + 1, row),
                                c = corner(column + 1, row + 1), d = corner(column, row + 1);
            add(a, b, c);
            add(a, c, d);
        }
    return mesh;
}

void makeFlat(build::Mesh& mesh) {
    mesh.normals.clear();
    mesh.isFlat = true;
    for (build::MeshPart& part : mesh.parts)
        for (build::MeshTriangle& triangle : part)
            for (build::Corner& corner : triangle)
                corner.normal = kNoNormals;
}

/// Around the z axis; exactly where the sides begin and end.
glm::dvec2 direction(double share) {
    const double turn = share >= 1 ? 0 : share;
    return {std::cos(2 * kPi * turn), std::sin(2 * kPi * turn)};
}

} // namespace

build::Mesh rectangleMesh() {
    build::Mesh mesh = grid(1, 1, [](double s, double t) {
        return Vertex{{2 * s - 1, 2 * t - 1, 0}, {0, 0, 1}, {s, t}};
    });
    makeFlat(mesh);
    return mesh;
}

build::Mesh cubeMesh() {
    build::Mesh cube;
    cube.parts.emplace_back();
    for (const int axis : {0, 1, 2})
        for (const double side : {-1.0, 1.0}) {
            const build::Mesh face = grid(1, 1, [&](double s, double t) {
                Vertex v;
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
    build::Mesh mesh = grid(1, kSides, [](double s, double t) {
        return Vertex{{s * direction(t), 0}, {0, 0, 1}, {s, t}};
    });
    makeFlat(mesh);
    return mesh;
}

build::Mesh sphereMesh() {
    return grid(kSides, kSides / 2, [](double s, double t) {
        const double theta = kPi * (1 - t); // from the lower pole up
        const double radius = t <= 0 || t >= 1 ? 0 : std::sin(theta);
        const glm::dvec3 p(radius * direction(s), std::cos(theta));
        return Vertex{p, p, {s, 1 - t}};
    });
}

build::Mesh cylinderMesh(const glm::dvec3& from, const glm::dvec3& to, double radius) {
    const glm::dvec3 axis = glm::normalize(to - from);
    const glm::dvec3 across = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(across - axis * glm::dot(axis, across));
    const glm::dvec3 y = glm::cross(axis, x);
    return grid(kSides, 1, [&](double s, double t) {
        const glm::dvec2 d = direction(s);
        const glm::dvec3 normal = x * d.x + y * d.y;
        return Vertex{glm::mix(from, to, t) + radius * normal, normal, {s, t}};
    });
}

void flip(build::Mesh& mesh) {
    for (glm::dvec3& normal : mesh.normals)
        normal = -normal;
    for (build::MeshPart& part : mesh.parts)
        for (build::MeshTriangle& triangle : part)
            std::swap(triangle[1], triangle[2]);
}

void computeNormals(build::Mesh& mesh) {
    using Key = std::tuple<uint32_t, float, float>;
    std::map<Key, uint32_t> numbers;
    const auto numberOf = [&](const build::Corner& corner) {
        const glm::vec2 uv = corner.attributes == kNoAttributes
                                 ? glm::vec2(0)
                                 : mesh.attributes[corner.attributes].uv[0];
        const auto [found, isNew] =
            numbers.try_emplace({corner.position, uv.x, uv.y}, uint32_t(mesh.normals.size()));
        if (isNew) mesh.normals.emplace_back(0.0);
        return found->second;
    };
    mesh.normals.clear();
    for (build::MeshPart& part : mesh.parts)
        for (build::MeshTriangle& triangle : part) {
            const auto p = [&](size_t i) { return mesh.positions[triangle[i % 3].position]; };
            const std::optional<glm::dvec3> normal =
                build::unit(glm::cross(p(1) - p(0), p(2) - p(0)));
            for (size_t i = 0; i < 3; ++i) {
                triangle[i].normal = numberOf(triangle[i]);
                const std::optional<double> angle = build::angleAt(p(i), p(i + 1), p(i + 2));
                if (normal && angle) mesh.normals[triangle[i].normal] += *normal * *angle;
            }
        }
}

} // namespace stromboli::mitsuba
