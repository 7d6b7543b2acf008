#include "scene/model/medium.hpp"

#include "scene/model/scene.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {

glm::dvec3 DensityGrid::place(const glm::dvec3& world) const {
    glm::dvec3 p;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec4& row = toUnit[size_t(i)];
        p[i] = glm::dot(glm::dvec3(row), world) + row.w;
    }
    return p;
}

void DensityGrid::setWorld(const glm::dmat4& matrix) {
    const glm::dmat4 rows = glm::transpose(glm::inverse(matrix));
    for (int i = 0; i < 3; ++i)
        toUnit[size_t(i)] = rows[i];
}

double DensityGrid::at(const glm::dvec3& place) const {
    for (int i = 0; i < 3; ++i)
        if (!(place[i] >= 0 && place[i] <= 1)) return 0;
    size_t low[3], high[3];
    double part[3];
    for (int i = 0; i < 3; ++i) {
        const double most = size[i] - 1.0;
        const double x = std::clamp(place[i] * size[i] - 0.5, 0.0, most);
        low[i] = size_t(x);
        high[i] = std::min(low[i] + 1, size_t(most));
        part[i] = x - double(low[i]);
    }
    double sum = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        size_t at[3];
        double weight = 1;
        for (unsigned i = 0; i < 3; ++i) {
            const bool isHigh = corner >> i & 1;
            at[i] = isHigh ? high[i] : low[i];
            weight *= isHigh ? part[i] : 1 - part[i];
        }
        sum += weight * values[at[0] + size.x * (at[1] + size_t(size.y) * at[2])];
    }
    return sum;
}

float DensityGrid::largest() const {
    return values.empty() ? 0 : std::ranges::max(values);
}

namespace {

/// The medium inside a material that states none: what it absorbs, if it does.
uint32_t mediumInside(Scene& scene, const Material& m) {
    if (m.kind != MaterialKind::Principled) return kNoMedium;
    Medium medium;
    medium.name = m.name;
    medium.absorption = m.principled.absorption();
    if (medium.absorption == glm::vec3(0)) return kNoMedium;
    scene.media.push_back(std::move(medium));
    return uint32_t(scene.media.size() - 1);
}

bool usesMedia(const Scene& scene) {
    const auto isThere = [](uint32_t medium) { return medium != kNoMedium; };
    return isThere(scene.surrounding.medium) ||
           std::ranges::any_of(scene.cameras, isThere, &FileCamera::medium) ||
           std::ranges::any_of(scene.materials, isThere, &Material::inside) ||
           std::ranges::any_of(scene.materials, isThere, &Material::outside);
}

} // namespace

void resolveMedia(Scene& scene) {
    if (!usesMedia(scene)) {
        scene.media.clear();
        for (Material& m : scene.materials)
            m.boundsMedia = false;
    }
    if (scene.media.empty()) return;
    for (Material& m : scene.materials) {
        if (m.boundsMedia || m.isNull() || !m.entersVolume()) continue;
        m.inside = mediumInside(scene, m);
        m.outside = scene.surrounding.medium;
        m.boundsMedia = true;
    }
}

} // namespace stromboli
