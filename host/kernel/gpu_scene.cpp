#include "host/kernel/gpu_scene.hpp"

#include "host/kernel/gpu_lights.hpp"
#include "host/kernel/lamp_gap.hpp"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

gpu::Material packMaterial(const Material& m, bool cs184) {
    gpu::Material g{};
    g.kind = uint32_t(m.kind); // the enumerations agree: see the static_asserts below
    g.reflectance = m.kind == MaterialKind::Diffuse ? m.albedo : m.reflectance;
    g.emission = m.emission;
    g.light = gpu::NO_LIGHT;
    g.emitsBothSides = m.emitsBothSides || cs184;
    if (m.kind == MaterialKind::Microfacet) {
        g.transmittanceOrEta = m.eta;
        g.iorOrAlpha = m.alpha;
        g.k = m.k;
    } else {
        g.transmittanceOrEta = m.transmittance;
        g.iorOrAlpha = m.ior;
    }
    return g;
}

static_assert(uint32_t(MaterialKind::Diffuse) == gpu::MATERIAL_DIFFUSE);
static_assert(uint32_t(MaterialKind::Mirror) == gpu::MATERIAL_MIRROR);
static_assert(uint32_t(MaterialKind::Refraction) == gpu::MATERIAL_REFRACTION);
static_assert(uint32_t(MaterialKind::Glass) == gpu::MATERIAL_GLASS);
static_assert(uint32_t(MaterialKind::Microfacet) == gpu::MATERIAL_MICROFACET);

gpu::Primitive packFlatTriangle(const Scene& scene, const Triangle& t) {
    const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                     c = scene.positions[t.corner[2]];
    const glm::uvec3 bits =
        glm::floatBitsToUint(glm::vec3(glm::normalize(glm::cross(b - a, c - a))));
    return {t.material, bits.x, bits.y, bits.z};
}

/// firstCorner: the corner of the file that the leaf has first.
gpu::Primitive packTriangle(const Scene& scene, const Triangle& t, uint32_t firstCorner) {
    if (t.normals[0] == kNoNormals) return packFlatTriangle(scene, t);
    const auto normal = [&](uint32_t c) {
        return encodeNormal(scene.normals[t.normals[(c + firstCorner) % 3]]);
    };
    return {t.material | gpu::PRIMITIVE_IS_SMOOTH, normal(0), normal(1), normal(2)};
}

void packPrimitives(const Scene& scene, GpuScene& g) {
    const auto triangles = uint32_t(scene.triangles.size());
    g.hasTriangles = triangles > 0;
    g.hasSpheres = !scene.spheres.empty();
    g.primitives.reserve(g.bvh.primitiveOrder.size());
    for (const uint32_t id : g.bvh.primitiveOrder) {
        g.primitives.push_back(
            id < triangles ? packTriangle(scene, scene.triangles[id], g.bvh.firstCorner[id])
                           : gpu::Primitive{scene.spheres[id - triangles].material, 0, 0, 0});
        g.hasNormals |= (g.primitives.back().material & gpu::PRIMITIVE_IS_SMOOTH) != 0;
    }
}

} // namespace

uint32_t encodeNormal(const glm::vec3& n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    glm::vec2 e(n.x / sum, n.y / sum);
    if (n.z < 0) {
        const glm::vec2 folded(1 - std::abs(e.y), 1 - std::abs(e.x));
        e = {e.x >= 0 ? folded.x : -folded.x, e.y >= 0 ? folded.y : -folded.y};
    }
    return glm::packSnorm2x16(e);
}

glm::vec3 decodeNormal(uint32_t code) {
    const glm::vec2 e = glm::unpackSnorm2x16(code);
    glm::vec3 n(e.x, e.y, 1 - std::abs(e.x) - std::abs(e.y));
    const float fold = std::max(-n.z, 0.0f);
    n.x += n.x >= 0 ? -fold : fold;
    n.y += n.y >= 0 ? -fold : fold;
    return glm::normalize(n);
}

GpuScene packScene(const Scene& scene, WideLayout bvh, bool cs184, LightChoice choice) {
    GpuScene g;
    g.lightChoice = choice;
    g.bvh = std::move(bvh);
    packPrimitives(scene, g);
    for (const Material& m : scene.materials)
        g.materials.push_back(packMaterial(m, cs184));
    packLights(scene, g.bvh.placeOf, cs184, g);
    if (!cs184) g.lampGap = lampGap(g);
    return g;
}

} // namespace stromboli
