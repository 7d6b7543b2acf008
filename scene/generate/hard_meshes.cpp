#include "scene/generate/hard_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace stromboli {
namespace {

Scene meshOf(std::vector<glm::vec3> positions) {
    Scene scene;
    scene.positions = std::move(positions);
    scene.materials.resize(1);
    scene.instances = {"mesh"};
    return scene;
}

void addTriangle(Scene& scene, uint32_t a, uint32_t b, uint32_t c) {
    Triangle t;
    t.corner[0] = a, t.corner[1] = b, t.corner[2] = c;
    scene.triangles.push_back(t);
}

/// Divides every triangle into four, at the middles of its edges.
Scene divided(const Scene& mesh) {
    Scene result = meshOf(mesh.positions);
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
        const auto [entry, isNew] =
            middles.try_emplace(std::minmax(a, b), uint32_t(result.positions.size()));
        if (isNew) result.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
        return entry->second;
    };
    for (const Triangle& t : mesh.triangles) {
        const uint32_t a = t.corner[0], b = t.corner[1], c = t.corner[2];
        const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        addTriangle(result, a, ab, ca);
        addTriangle(result, ab, b, bc);
        addTriangle(result, ca, bc, c);
        addTriangle(result, ab, bc, ca);
    }
    return result;
}

} // namespace

Scene starMesh(uint32_t levels, Random& random) {
    Scene mesh = meshOf({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
    for (const auto& [x, y] : {std::pair{0u, 2u}, {2u, 1u}, {1u, 3u}, {3u, 0u}}) {
        addTriangle(mesh, x, y, 4);
        addTriangle(mesh, y, x, 5);
    }
    for (uint32_t i = 0; i < levels; ++i)
        mesh = divided(mesh);
    for (glm::vec3& p : mesh.positions)
        p = glm::normalize(p) * random.uniform(0.6f, 1.4f);
    return mesh;
}

Scene integerTerrain(uint32_t n, Random& random) {
    Scene mesh = meshOf({});
    for (uint32_t i = 0; i <= n; ++i)
        for (uint32_t j = 0; j <= n; ++j)
            mesh.positions.emplace_back(float(i), float(random.below(4)), float(j));
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            const uint32_t a = i * (n + 1) + j, b = a + n + 1;
            addTriangle(mesh, a, a + 1, b + 1);
            addTriangle(mesh, a, b + 1, b);
        }
    return mesh;
}

Scene tessellatedSphere(uint32_t rings) {
    const uint32_t sectors = 2 * rings;
    Scene mesh = meshOf({{0, 0, 1}});
    for (uint32_t i = 1; i < rings; ++i)
        for (uint32_t j = 0; j < sectors; ++j) {
            const double polar = M_PI * i / rings, azimuth = 2 * M_PI * j / sectors;
            mesh.positions.emplace_back(std::sin(polar) * std::cos(azimuth),
                                        std::sin(polar) * std::sin(azimuth), std::cos(polar));
        }
    mesh.positions.emplace_back(0.0f, 0.0f, -1.0f);
    const uint32_t last = uint32_t(mesh.positions.size()) - 1;
    const auto corner = [&](uint32_t i, uint32_t j) {
        return i == 0 ? 0 : i == rings ? last : 1 + (i - 1) * sectors + j % sectors;
    };
    for (uint32_t i = 0; i < rings; ++i)
        for (uint32_t j = 0; j < sectors; ++j) {
            if (i > 0) addTriangle(mesh, corner(i, j), corner(i + 1, j), corner(i, j + 1));
            if (i + 1 < rings)
                addTriangle(mesh, corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1));
        }
    return mesh;
}

Scene soup(uint32_t triangles, uint32_t spheres, float size, Random& random) {
    Scene scene = meshOf({});
    for (uint32_t i = 0; i < triangles; ++i) {
        const glm::vec3 middle = random.inCube(1);
        for (int c = 0; c < 3; ++c)
            scene.positions.push_back(middle + random.inCube(size));
        addTriangle(scene, 3 * i, 3 * i + 1, 3 * i + 2);
    }
    for (uint32_t i = 0; i < spheres; ++i) {
        Sphere s;
        s.center = random.inCube(1);
        s.radius = random.uniform(0.1f, 1.0f) * size;
        scene.spheres.push_back(s);
    }
    return scene;
}

void translate(Scene& scene, const glm::vec3& by) {
    for (glm::vec3& p : scene.positions)
        p += by;
    for (Sphere& s : scene.spheres)
        s.center += by;
}

} // namespace stromboli
