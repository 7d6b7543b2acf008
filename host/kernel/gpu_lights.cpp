#include "host/kernel/gpu_lights.hpp"

#include "host/kernel/alias_table.hpp"
#include "host/kernel/light_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace stromboli {
namespace {

gpu::Light quadLight(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b,
                     const glm::vec3& radiance, bool bothSides) {
    gpu::Light g{};
    g.kind = gpu::LIGHT_QUAD;
    g.position = corner;
    g.edgeA = a;
    g.edgeB = b;
    g.area = float(glm::length(glm::cross(glm::dvec3(a), glm::dvec3(b))));
    g.color = radiance;
    g.bothSides = bothSides;
    return g;
}

/// One column per triangle, chosen in proportion to its area.
void addEntries(const Scene& scene, const Emitter& e, const std::vector<uint32_t>& placeOf,
                GpuScene& g) {
    std::vector<double> areas;
    for (uint32_t i : e.triangles) {
        const Triangle& t = scene.triangles[i];
        const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                         c = scene.positions[t.corner[2]];
        areas.push_back(0.5 * glm::length(glm::cross(b - a, c - a)));
    }
    const std::vector<AliasColumn> table = buildAliasTable(areas);
    for (size_t i = 0; i < table.size(); ++i)
        g.emitterEntries.push_back({placeOf[e.triangles[i]], placeOf[e.triangles[table[i].alias]],
                                    float(table[i].threshold), 0});
}

gpu::Light packEmitter(const Scene& scene, const Emitter& e, const std::vector<uint32_t>& placeOf,
                       GpuScene& g) {
    const Material& m = scene.materials[e.material];
    if (e.kind == EmitterKind::Quad)
        return quadLight(e.corner, e.edgeA, e.edgeB, m.emission, m.emitsBothSides);
    gpu::Light light{};
    light.color = m.emission;
    light.bothSides = m.emitsBothSides;
    light.area = float(e.area);
    if (e.kind == EmitterKind::Sphere) {
        light.kind = gpu::LIGHT_SPHERE;
        light.position = scene.spheres[e.sphere].center;
        light.edgeA.x = scene.spheres[e.sphere].radius;
    } else {
        light.kind = gpu::LIGHT_MESH;
        light.firstEntry = uint32_t(g.emitterEntries.size());
        light.entryCount = uint32_t(e.triangles.size());
        addEntries(scene, e, placeOf, g);
    }
    return light;
}

void addNode(const gpu::LightNode& node, uint32_t firstEntry, GpuScene& g) {
    gpu::LightNode n = node;
    if (n.child & gpu::LIGHT_NODE_IS_LEAF) n.child += firstEntry; // rows of the whole buffer
    for (const gpu::EmitterEntry& row : std::bit_cast<std::array<gpu::EmitterEntry, 2>>(n))
        g.emitterEntries.push_back(row);
}

/// All emissive triangles as one light.
gpu::Light packManyTriangles(const Scene& scene, const std::vector<Emitter>& emitters,
                             const std::vector<uint32_t>& placeOf, GpuScene& g) {
    std::vector<LightTriangle> triangles = lightTriangles(scene, emitters);
    gpu::Light light{};
    light.kind = gpu::LIGHT_MESH;
    double power = 0;
    for (LightTriangle& t : triangles) {
        t.id = placeOf[t.id];
        power += t.power;
    }
    light.area = float(power);
    light.entryCount = uint32_t(triangles.size());
    light.firstEntry = uint32_t(g.emitterEntries.size());
    g.manyLampTriangles = true;
    if (g.lightChoice != LightChoice::Tree) {
        const auto table = lightTable(triangles, g.lightChoice == LightChoice::Uniform);
        g.emitterEntries.insert(g.emitterEntries.end(), table.begin(), table.end());
        return light;
    }
    const LightTree tree = buildLightTree(std::move(triangles));
    g.lightTreeLevels = tree.levels;
    const uint32_t firstEntry = light.firstEntry;
    g.emitterEntries.insert(g.emitterEntries.end(), tree.entries.begin(), tree.entries.end());
    light.firstEntry = uint32_t(g.emitterEntries.size());
    for (const gpu::LightNode& node : tree.nodes)
        addNode(node, firstEntry, g);
    return light;
}

gpu::Light packLight(const Light& l, bool cs184) {
    gpu::Light g{};
    g.color = l.color;
    switch (l.kind) {
    case LightKind::Area: {
        // The kernel's normal is edgeA x edgeB: swap the edges where the light faces the other way.
        const bool swap = glm::dot(glm::cross(l.edgeX, l.edgeY), l.direction) < 0;
        const glm::vec3 a = swap ? l.edgeY : l.edgeX, b = swap ? l.edgeX : l.edgeY;
        return quadLight(l.position - 0.5f * a - 0.5f * b, a, b, l.color, false);
    }
    case LightKind::Ambient:
        g.kind = gpu::LIGHT_AMBIENT;
        if (l.upperHemisphereOnly || cs184) g.flags = gpu::LIGHT_UPPER_HEMISPHERE_ONLY;
        break;
    case LightKind::Directional:
        g.kind = gpu::LIGHT_DIRECTIONAL;
        g.position = -l.direction;
        break;
    case LightKind::Point:
    case LightKind::Spot:
        g.kind = l.kind == LightKind::Spot ? gpu::LIGHT_SPOT : gpu::LIGHT_POINT;
        g.position = l.position;
        g.edgeA = l.direction;
        g.edgeB = {l.constantAttenuation, l.linearAttenuation, l.quadraticAttenuation};
        g.cosCutoff = std::cos(0.5f * l.falloffAngle);
        g.falloffExponent = l.falloffExponent;
        if (cs184) { // no attenuation; spot lights shine nowhere
            g.edgeB = {1, 0, 0};
            if (l.kind == LightKind::Spot) g.color = {0, 0, 0};
        }
        break;
    }
    return g;
}

/// Gives each emitter that is a light of its own a material that names that light. Only where rough
/// metals make use of it.
void nameLights(const Scene& scene, const std::vector<Emitter>& emitters, GpuScene& g) {
    const bool metals =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return m.kind == MaterialKind::Microfacet; });
    if (!metals) return;
    std::vector<uint32_t> lightOf(scene.triangles.size() + scene.spheres.size(), gpu::NO_LIGHT);
    uint32_t light = g.manyLampTriangles ? 1 : 0; // the first is that of many triangles
    for (const Emitter& e : emitters) {
        if (g.manyLampTriangles && e.kind != EmitterKind::Sphere) continue;
        if (e.kind == EmitterKind::Sphere) lightOf[scene.triangles.size() + e.sphere] = light;
        for (const uint32_t triangle : e.triangles)
            lightOf[triangle] = light;
        if (e.kind != EmitterKind::Sphere) g.lights[light].flags |= gpu::LIGHT_FOUND_BY_BOUNCES;
        ++light;
    }
    std::vector<uint32_t> materialNaming(light, gpu::NO_LIGHT);
    for (size_t i = 0; i < g.primitives.size(); ++i) {
        gpu::Primitive& p = g.primitives[i];
        const uint32_t named = lightOf[g.bvh.primitiveOrder[i]];
        if (named == gpu::NO_LIGHT) continue;
        if (materialNaming[named] == gpu::NO_LIGHT) {
            materialNaming[named] = uint32_t(g.materials.size());
            g.materials.push_back(g.materials[materialOf(p)]);
            g.materials.back().light = named;
        }
        p.material = materialNaming[named] | (p.material & gpu::PRIMITIVE_IS_SMOOTH);
    }
}

} // namespace

void packLights(const Scene& scene, const std::vector<uint32_t>& placeOf, bool cs184, GpuScene& g) {
    if (!cs184) {
        const std::vector<Emitter> emitters = collectEmitters(scene);
        const bool many = haveManyTriangles(emitters);
        if (many) g.lights.push_back(packManyTriangles(scene, emitters, placeOf, g));
        for (const Emitter& e : emitters)
            if (!many || e.kind == EmitterKind::Sphere)
                g.lights.push_back(packEmitter(scene, e, placeOf, g));
        nameLights(scene, emitters, g);
    }
    for (const Light& l : scene.lights)
        if (!l.isDelta()) g.lights.push_back(packLight(l, cs184));
    g.areaLights = uint32_t(g.lights.size());
    for (const Light& l : scene.lights)
        if (l.isDelta()) g.lights.push_back(packLight(l, cs184));
    g.deltaLights = uint32_t(g.lights.size()) - g.areaLights;
}

} // namespace stromboli
