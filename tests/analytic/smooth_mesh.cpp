#include "tests/analytic/smooth_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

glm::dvec3 cornerOf(const Scene& scene, const Triangle& t, int c) {
    return scene.positions[t.corner[c]];
}

glm::dvec3 normalOf(const Scene& scene, const Triangle& t) {
    const glm::dvec3 a = cornerOf(scene, t, 0);
    return glm::normalize(glm::cross(cornerOf(scene, t, 1) - a, cornerOf(scene, t, 2) - a));
}

/// A triangle whose corners are also its normals.
void addFacet(SceneMaker& builder, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
              uint32_t material) {
    builder.triangle(a, b, c, material);
    setNormals(builder.scene, builder.scene.triangles.size() - 1, a, b, c);
}

} // namespace

void addSmoothSphere(SceneMaker& builder, uint32_t rows, uint32_t columns, uint32_t material) {
    const auto point = [&](uint32_t row, uint32_t column) {
        const double theta = 3.14159265358979323846 * row / rows;
        const double phi = 2 * 3.14159265358979323846 * (column % columns) / columns;
        return glm::vec3(glm::dvec3(std::sin(theta) * std::sin(phi), std::cos(theta),
                                    std::sin(theta) * std::cos(phi)));
    };
    builder.startInstance();
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) {
            const glm::vec3 a = point(r, c), b = point(r, c + 1);
            const glm::vec3 below = point(r + 1, c), belowB = point(r + 1, c + 1);
            if (r > 0) addFacet(builder, a, below, b, material);
            if (r + 1 < rows) addFacet(builder, b, below, belowB, material);
        }
}

void setNormals(Scene& scene, size_t index, const glm::vec3& n0, const glm::vec3& n1,
                const glm::vec3& n2) {
    Triangle& t = scene.triangles[index];
    for (int c = 0; c < 3; ++c) {
        t.normals[c] = uint32_t(scene.normals.size());
        scene.normals.push_back(glm::normalize(c == 0 ? n0 : c == 1 ? n1 : n2));
    }
}

std::optional<MeshPoint> firstTriangle(const Scene& scene, const glm::dvec3& origin,
                                       const glm::dvec3& direction) {
    std::optional<MeshPoint> nearest;
    double nearestT = 0;
    for (const Triangle& t : scene.triangles) {
        const glm::dvec3 a = cornerOf(scene, t, 0), e1 = cornerOf(scene, t, 1) - a,
                         e2 = cornerOf(scene, t, 2) - a;
        const glm::dvec3 p = glm::cross(direction, e2), s = origin - a, q = glm::cross(s, e1);
        const double determinant = glm::dot(e1, p);
        const double b1 = glm::dot(s, p) / determinant, b2 = glm::dot(direction, q) / determinant;
        const double distance = glm::dot(e2, q) / determinant;
        if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && distance > 0)) continue;
        if (nearest && distance >= nearestT) continue;
        nearestT = distance;
        nearest = MeshPoint{origin + distance * direction, normalOf(scene, t), normalOf(scene, t)};
        if (t.normals[0] == kNoNormals) continue;
        const glm::dvec3 n0 = scene.normals[t.normals[0]], n1 = scene.normals[t.normals[1]],
                         n2 = scene.normals[t.normals[2]];
        nearest->shading = glm::normalize((1 - b1 - b2) * n0 + b1 * n1 + b2 * n2);
    }
    return nearest;
}

double largestTilt(const Scene& scene) {
    double least = 1;
    for (const Triangle& t : scene.triangles)
        for (const uint32_t n : t.normals)
            least = std::min(least, glm::dot(normalOf(scene, t), glm::dvec3(scene.normals[n])));
    return std::acos(least);
}

} // namespace stromboli::test
