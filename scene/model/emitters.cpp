#include "scene/model/emitters.hpp"

#include "scene/model/surface_lookup.hpp"

#include <glm/gtc/constants.hpp>

#include <cmath>
#include <map>
#include <utility>

namespace stromboli {
namespace {

double area(const Scene& scene, const Triangle& t) {
    const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                     c = scene.positions[t.corner[2]];
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

/// True if d completes the parallelogram a b c d but for the rounding of the four corners to float:
/// half an ulp, 2^-24, of each coordinate.
bool completes(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    for (int axis = 0; axis < 3; ++axis) {
        const double size =
            std::abs(a[axis]) + std::abs(b[axis]) + std::abs(c[axis]) + std::abs(d[axis]);
        if (std::abs(a[axis] + (c[axis] - b[axis]) - d[axis]) > 0x1p-24 * size) return false;
    }
    return true;
}

/// Recognises two triangles a b c and c d a (from any starting corner) with d = a + c - b, as far
/// as float can tell: then sampling the parallelogram is sampling the triangles.
bool asParallelogram(const Scene& scene, Emitter& emitter) {
    if (emitter.triangles.size() != 2) return false;
    const Triangle& s = scene.triangles[emitter.triangles[0]];
    const Triangle& t = scene.triangles[emitter.triangles[1]];
    const auto at = [&](const Triangle& tri, int i) { return scene.positions[tri.corner[i % 3]]; };
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const glm::vec3 a = at(s, i), b = at(s, i + 1), c = at(s, i + 2);
            if (at(t, j) != c || at(t, j + 2) != a) continue;
            if (!completes(a, b, c, at(t, j + 1))) continue;
            emitter.corner = b;
            emitter.edgeA = c - b;
            emitter.edgeB = a - b;
            return true;
        }
    return false;
}

bool emitsAlikeEverywhere(const Material& m) {
    return m.alphaMode == AlphaMode::Opaque && !textureIn(m, TextureSlot::Emission);
}

} // namespace

bool haveManyTriangles(const std::vector<Emitter>& emitters) {
    size_t triangles = 0;
    for (const Emitter& emitter : emitters)
        triangles += emitter.triangles.size();
    return triangles >= kManyEmissiveTriangles;
}

std::vector<Emitter> collectEmitters(const Scene& scene) {
    std::map<std::pair<uint32_t, uint32_t>, Emitter> meshes; // by instance, then material
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        if (!scene.materials[t.material].emits()) continue;
        Emitter& emitter = meshes[{t.instance, t.material}];
        emitter.material = t.material;
        emitter.triangles.push_back(i);
        emitter.area += area(scene, t);
    }
    std::vector<Emitter> emitters;
    for (auto& [key, emitter] : meshes) {
        const bool isQuad = emitsAlikeEverywhere(scene.materials[emitter.material]) &&
                            asParallelogram(scene, emitter);
        emitter.kind = isQuad ? EmitterKind::Quad : EmitterKind::Mesh;
        emitters.push_back(std::move(emitter));
    }
    for (uint32_t i = 0; i < scene.spheres.size(); ++i) {
        const Sphere& s = scene.spheres[i];
        if (!scene.materials[s.material].emits()) continue;
        Emitter& emitter = emitters.emplace_back();
        emitter.kind = EmitterKind::Sphere;
        emitter.material = s.material;
        emitter.sphere = i;
        emitter.area = 4 * glm::pi<double>() * double(s.radius) * double(s.radius);
    }
    return emitters;
}

} // namespace stromboli
