#include "scene/build/surface_mesh.hpp"

#include "scene/build/vectors.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

namespace stromboli::build {

Mesh gridMesh(uint32_t columns, uint32_t rows,
              const std::function<SurfacePoint(double, double)>& at) {
    Mesh mesh;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column) {
            const SurfacePoint v = at(double(column) / columns, double(row) / rows);
            mesh.positions.push_back(v.position);
            mesh.normals.push_back(v.normal);
            mesh.attributes.emplace_back().uv[0] = v.uv;
        }
    MeshPart& part = mesh.parts.emplace_back();
    const auto corner = [&](uint32_t column, uint32_t row) {
        const uint32_t number = row * (columns + 1) + column;
        return Corner{number, number, number};
    };
    const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
        // At poles a side of the quadrangle is a point.
        const auto p = [&](const Corner& k) { return mesh.positions[k.position]; };
        if (glm::length(glm::cross(p(b) - p(a), p(c) - p(a))) > 0) part.push_back({a, b, c});
    };
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const Corner a = corner(column, row), b = corner(column + 1, row),
                         c = corner(column + 1, row + 1), d = corner(column, row + 1);
            add(a, b, c);
            add(a, c, d);
        }
    return mesh;
}

Mesh sphereMesh(uint32_t sides) {
    constexpr double kPi = std::numbers::pi;
    return gridMesh(sides, sides / 2, [](double s, double t) {
        const double theta = kPi * (1 - t); // from the lower pole up
        const double radius = t <= 0 || t >= 1 ? 0 : std::sin(theta);
        const glm::dvec2 round =
            s >= 1 ? glm::dvec2(1, 0) : glm::dvec2(std::cos(2 * kPi * s), std::sin(2 * kPi * s));
        const glm::dvec3 p(radius * round, std::cos(theta));
        return SurfacePoint{p, p, {s, 1 - t}};
    });
}

void makeFlat(Mesh& mesh) {
    mesh.normals.clear();
    mesh.isFlat = true;
    for (MeshPart& part : mesh.parts)
        for (MeshTriangle& triangle : part)
            for (Corner& corner : triangle)
                corner.normal = kNoNormals;
}

void flip(Mesh& mesh) {
    for (glm::dvec3& normal : mesh.normals)
        normal = -normal;
    for (MeshPart& part : mesh.parts)
        for (MeshTriangle& triangle : part)
            std::swap(triangle[1], triangle[2]);
}

void computeNormals(Mesh& mesh) {
    using Key = std::tuple<uint32_t, float, float>;
    std::map<Key, uint32_t> numbers;
    const auto numberOf = [&](const Corner& corner) {
        const glm::vec2 uv = corner.attributes == kNoAttributes
                                 ? glm::vec2(0)
                                 : mesh.attributes[corner.attributes].uv[0];
        const auto [found, isNew] =
            numbers.try_emplace({corner.position, uv.x, uv.y}, uint32_t(mesh.normals.size()));
        if (isNew) mesh.normals.emplace_back(0.0);
        return found->second;
    };
    mesh.normals.clear();
    for (MeshPart& part : mesh.parts)
        for (MeshTriangle& triangle : part) {
            const auto p = [&](size_t i) { return mesh.positions[triangle[i % 3].position]; };
            const std::optional<glm::dvec3> normal = unit(glm::cross(p(1) - p(0), p(2) - p(0)));
            for (size_t i = 0; i < 3; ++i) {
                triangle[i].normal = numberOf(triangle[i]);
                const std::optional<double> angle = angleAt(p(i), p(i + 1), p(i + 2));
                if (normal && angle) mesh.normals[triangle[i].normal] += *normal * *angle;
            }
        }
}

} // namespace stromboli::build
