#include "scene/model/scene.hpp"

namespace stromboli {

float Bounds::halfArea() const {
    if (empty()) return 0;
    const glm::vec3 e = extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

Bounds Scene::bounds() const {
    Bounds b;
    for (const Triangle& t : triangles)
        for (uint32_t corner : t.corner)
            b.extend(positions[corner]);
    for (const Sphere& s : spheres) {
        b.extend(s.center - glm::vec3(s.radius));
        b.extend(s.center + glm::vec3(s.radius));
    }
    return b;
}

glm::vec3 Scene::geometricNormal(const Triangle& t) const {
    const glm::dvec3 a = positions[t.corner[0]], b = positions[t.corner[1]],
                     c = positions[t.corner[2]];
    return glm::normalize(glm::cross(b - a, c - a));
}

} // namespace stromboli
