#include "tests/bvh/fixtures.hpp"

#include "host/bvh/leaf_items.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace stromboli::test {

namespace {

void addIndexedTriangle(Scene& scene, uint32_t a, uint32_t b, uint32_t c) {
    Triangle t;
    t.corner[0] = a, t.corner[1] = b, t.corner[2] = c;
    scene.triangles.push_back(t);
}

} // namespace

Traceable::Traceable(Scene scene_, const BuildOptions& options)
    : scene(std::move(scene_)), layout(buildWideBvh(scene, options)),
      primitiveAt(2 * layout.records.size(), gpu::NO_PRIMITIVE) {
    for (uint32_t i = 0; i < layout.placeOf.size(); ++i)
        primitiveAt.at(layout.placeOf[i]) = i;
}

std::optional<PrimitiveHit> Traceable::hitPrimitive(uint32_t primitive, const PreparedRay& ray,
                                                    float tMin, float tMax) const {
    if (primitive >= scene.triangles.size()) {
        const Sphere& s = scene.spheres[primitive - scene.triangles.size()];
        return hitSphere(s.center, s.radius, ray, tMin, tMax);
    }
    const auto corner = [&](uint32_t c) {
        const uint32_t rotated = (c + layout.firstCorner[primitive]) % 3;
        return scene.positions[scene.triangles[primitive].corner[rotated]];
    };
    const auto hit = hitTriangle(corner(0), corner(1), corner(2), ray);
    return hit && hit->t > tMin && hit->t < tMax ? hit : std::nullopt;
}

void addTriangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const uint32_t first = uint32_t(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {a, b, c});
    addIndexedTriangle(scene, first, first + 1, first + 2);
}

Scene cubeMesh(uint32_t n) {
    Scene mesh;
    std::map<std::array<uint32_t, 3>, uint32_t> corners;
    for (int axis = 0; axis < 3; ++axis)
        for (const uint32_t side : {0u, n}) {
            const auto corner = [&](uint32_t i, uint32_t j) {
                std::array<uint32_t, 3> at{};
                at[size_t(axis)] = side, at[size_t(axis + 1) % 3] = i, at[size_t(axis + 2) % 3] = j;
                const auto [entry, isNew] =
                    corners.try_emplace(at, uint32_t(mesh.positions.size()));
                const glm::vec3 grid{at[0], at[1], at[2]};
                if (isNew) mesh.positions.push_back(grid * (2.0f / float(n)) - 1.0f);
                return entry->second;
            };
            for (uint32_t i = 0; i < n; ++i)
                for (uint32_t j = 0; j < n; ++j) {
                    addIndexedTriangle(mesh, corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
                    addIndexedTriangle(mesh, corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
                }
        }
    return mesh;
}

Scene landscape(uint32_t n) {
    Scene scene;
    const auto at = [n](uint32_t i, uint32_t j) {
        const float x = 2 * float(i) / float(n) - 1, y = 2 * float(j) / float(n) - 1;
        return glm::vec3(x, y, 0.2f * std::sin(7 * x) * std::cos(5 * y) + 0.02f * std::sin(40 * x));
    };
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            addTriangle(scene, at(i, j), at(i + 1, j), at(i + 1, j + 1));
            addTriangle(scene, at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    return scene;
}

Scene clusterInSoup(Random& random) {
    Scene scene = soup(2000, 0, 1e-4f, random);
    for (glm::vec3& p : scene.positions)
        p = 0.9f + 0.001f * p;
    const Scene stadium = soup(1000, 0, 0.3f, random);
    for (const Triangle& t : stadium.triangles)
        addTriangle(scene, stadium.positions[t.corner[0]], stadium.positions[t.corner[1]],
                    stadium.positions[t.corner[2]]);
    return scene;
}

Scene sliverStrip(uint32_t n) {
    Scene scene;
    const float width = 1.0f / float(n);
    for (uint32_t i = 0; i < n; ++i) {
        const float x = float(i) * width;
        addTriangle(scene, {x, 0, 0}, {x + width, 0, 0}, {x, 1, 0});
    }
    return scene;
}

std::vector<Bounds> boxesOf(const Scene& scene) {
    std::vector<Bounds> boxes;
    for (uint32_t i = 0; i < scene.triangles.size() + scene.spheres.size(); ++i)
        boxes.push_back(primitiveBounds(scene, i));
    return boxes;
}

void addRoom(Scene& scene) {
    const Scene room = cubeMesh(1);
    for (const Triangle& t : room.triangles)
        addTriangle(scene, room.positions[t.corner[0]], room.positions[t.corner[1]],
                    room.positions[t.corner[2]]);
}

void scale(Scene& scene, float factor) {
    for (glm::vec3& p : scene.positions)
        p *= factor;
    for (Sphere& s : scene.spheres)
        s.center *= factor, s.radius *= factor;
}

} // namespace stromboli::test
