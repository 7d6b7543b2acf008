#include "host/kernel/certain_shadow.hpp"

#include <glm/glm.hpp>

#include <algorithm>

namespace stromboli {

double certainThickness(const Scene& scene) {
    constexpr double kShare = 0x1p-17;
    glm::vec3 largest(0);
    for (const glm::vec3& p : scene.positions)
        largest = glm::max(largest, glm::abs(p));
    for (const Sphere& s : scene.spheres)
        largest = glm::max(largest, glm::abs(s.center) + s.radius);
    return kShare * double(std::max({largest.x, largest.y, largest.z}));
}

bool isOpaque(const Material& m) {
    return m.alphaMode == AlphaMode::Opaque && m.other == kNoMaterial && !m.boundsMedia;
}

} // namespace stromboli
