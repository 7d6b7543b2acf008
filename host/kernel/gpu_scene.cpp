#include "host/kernel/gpu_scene.hpp"

#include "host/kernel/gpu_lights.hpp"

#include <glm/gtc/packing.hpp>

#include <cmath>

namespace stromboli {
namespace {

gpu::Material packMaterial(const Material& m, bool cs184) {
    gpu::Material g{};
    g.kind = uint32_t(m.kind); // the enumerations agree: see the static_asserts below
    g.reflectance = m.kind == MaterialKind::Diffuse ? m.albedo : m.reflectance;
    g.emission = m.emission;
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

gpu::Primitive packTriangle(const Scene& scene, const Triangle& t,
                            std::vector<gpu::NormalTriple>& normals) {
    gpu::Primitive p{};
    p.v0 = scene.positions[t.corner[0]];
    p.v1 = scene.positions[t.corner[1]];
    p.v2 = scene.positions[t.corner[2]];
    p.material = t.material;
    p.kind = gpu::PRIMITIVE_TRIANGLE;
    p.normals = gpu::NO_NORMALS;
    if (t.normals[0] != kNoNormals) {
        p.normals = uint32_t(normals.size());
        normals.push_back({encodeNormal(scene.normals[t.normals[0]]),
                           encodeNormal(scene.normals[t.normals[1]]),
                           encodeNormal(scene.normals[t.normals[2]]), 0});
    }
    return p;
}

gpu::Primitive packSphere(const Sphere& s) {
    gpu::Primitive p{};
    p.v0 = s.center;
    p.v1.x = s.radius;
    p.material = s.material;
    p.normals = gpu::NO_NORMALS;
    p.kind = gpu::PRIMITIVE_SPHERE;
    return p;
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

GpuScene packScene(const Scene& scene, const BinaryTree& tree, bool cs184) {
    GpuScene g;
    g.bvh = layOut(tree);
    const auto triangles = uint32_t(scene.triangles.size());
    std::vector<uint32_t> slotOf(triangles + scene.spheres.size());
    for (uint32_t slot = 0; slot < g.bvh.primitiveOrder.size(); ++slot) {
        const uint32_t id = g.bvh.primitiveOrder[slot];
        slotOf[id] = slot;
        g.primitives.push_back(id < triangles ? packTriangle(scene, scene.triangles[id], g.normals)
                                              : packSphere(scene.spheres[id - triangles]));
    }
    for (const Material& m : scene.materials)
        g.materials.push_back(packMaterial(m, cs184));
    packLights(scene, slotOf, cs184, g);
    return g;
}

} // namespace stromboli
