#include "scene/model/scene.hpp"

#include "scene/model/placements.hpp"

#include <algorithm>

namespace stromboli {

float Bounds::halfArea() const {
    if (empty()) return 0;
    const glm::vec3 e = extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

Bounds Scene::bounds() const {
    Bounds b;
    for (uint32_t i = firstInWorld(); i < triangles.size(); ++i)
        for (const uint32_t corner : triangles[i].corner)
            b.extend(positions[corner]);
    const std::vector<Bounds> ofPrototypes = prototypeBounds(*this);
    for (const Placement& p : placements)
        b.extend(boundsInWorld(p, ofPrototypes[p.prototype]));
    for (const Sphere& s : spheres) {
        b.extend(s.center - glm::vec3(s.radius));
        b.extend(s.center + glm::vec3(s.radius));
    }
    return b;
}

bool Scene::isMoment() const {
    return lightsMove || std::ranges::find(movingInstances, true) != movingInstances.end();
}

uint64_t Scene::placedTriangles() const {
    uint64_t count = triangles.size() - firstInWorld();
    for (const Placement& p : placements)
        count += prototypes[p.prototype].triangles;
    return count;
}

glm::vec3 Scene::geometricNormal(const Triangle& t) const {
    const glm::dvec3 a = positions[t.corner[0]], b = positions[t.corner[1]],
                     c = positions[t.corner[2]];
    return glm::normalize(glm::cross(b - a, c - a));
}

} // namespace stromboli
