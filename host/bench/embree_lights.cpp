#include "host/bench/embree_lights.hpp"

#include "host/kernel/alias_table.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/light_tree.hpp"
#include "scene/model/emitters.hpp"

#include <cmath>

namespace stromboli::bench {
namespace {

native::LampTriangle lampTriangle(const Scene& scene, uint32_t index) {
    const Triangle& t = scene.triangles[index];
    const glm::vec3 corner = scene.positions[t.corner[0]];
    return {plain(corner),
            plain(scene.positions[t.corner[1]] - corner),
            plain(scene.positions[t.corner[2]] - corner),
            plain(scene.geometricNormal(t)),
            plain(scene.materials[t.material].emission),
            scene.materials[t.material].emitsBothSides};
}

double area(const Scene& scene, uint32_t index) {
    const Triangle& t = scene.triangles[index];
    const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                     c = scene.positions[t.corner[2]];
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

/// One column per triangle, chosen in proportion to its area.
void addColumns(const Scene& scene, const Emitter& emitter, native::Light& light,
                EmbreeLights& all) {
    const auto firstTriangle = uint32_t(all.triangles.size());
    std::vector<double> areas;
    for (const uint32_t index : emitter.triangles) {
        areas.push_back(area(scene, index));
        all.triangles.push_back(lampTriangle(scene, index));
    }
    light.firstColumn = uint32_t(all.columns.size());
    light.columnCount = uint32_t(areas.size());
    uint32_t own = firstTriangle;
    for (const AliasColumn& column : buildAliasTable(areas))
        all.columns.push_back({float(column.threshold), own++, firstTriangle + column.alias});
}

void addEmitter(const Scene& scene, const Emitter& emitter, EmbreeLights& all) {
    const Material& material = scene.materials[emitter.material];
    native::Light light{};
    light.color = plain(material.emission);
    light.bothSides = material.emitsBothSides;
    light.area = float(emitter.area);
    if (emitter.kind == EmitterKind::Quad) {
        const glm::dvec3 normal = glm::cross(glm::dvec3(emitter.edgeA), glm::dvec3(emitter.edgeB));
        light.kind = native::LightKind::Quad;
        light.position = plain(emitter.corner);
        light.edgeA = plain(emitter.edgeA);
        light.edgeB = plain(emitter.edgeB);
        light.area = float(glm::length(normal));
        light.normal = plain(glm::normalize(normal));
    } else if (emitter.kind == EmitterKind::Sphere) {
        light.kind = native::LightKind::Sphere;
        light.position = plain(scene.spheres[emitter.sphere].center);
        light.radius = scene.spheres[emitter.sphere].radius;
    } else {
        light.kind = native::LightKind::Mesh;
        addColumns(scene, emitter, light, all);
    }
    all.lights.push_back(light);
}

void addColumns(const std::vector<gpu::EmitterEntry>& entries, EmbreeLights& all) {
    for (const gpu::EmitterEntry& e : entries)
        all.columns.push_back({e.threshold, e.place, e.alias});
}

native::LightNode decoded(const gpu::LightNode& n) {
    native::LightNode node{};
    node.center = plain(n.center);
    node.radius = n.radius;
    node.axis = plain(decodeNormal(n.axis));
    node.cosSpread = n.cosSpread;
    node.power = n.power;
    node.child = n.child & gpu::LIGHT_NODE_CHILD_MASK;
    if (n.child & gpu::LIGHT_NODE_IS_LEAF)
        node.count = n.child >> gpu::LIGHT_NODE_COUNT_SHIFT & gpu::LIGHT_NODE_MOST_TRIANGLES;
    node.bothSides = n.child & gpu::LIGHT_NODE_BOTH_SIDES;
    return node;
}

/// All emissive triangles as one light, from the kernel's own tree or table.
void addManyTriangles(const Scene& scene, const std::vector<Emitter>& emitters, LightChoice choice,
                      EmbreeLights& all) {
    std::vector<LightTriangle> triangles = lightTriangles(scene, emitters);
    native::Light light{};
    light.kind = native::LightKind::Mesh;
    light.columnCount = uint32_t(triangles.size());
    double power = 0;
    for (LightTriangle& t : triangles) {
        all.triangles.push_back(lampTriangle(scene, t.id));
        t.id = uint32_t(all.triangles.size() - 1);
        power += t.power;
    }
    light.area = float(power);
    all.lights.push_back(light);
    if (choice != LightChoice::Tree) {
        const bool uniformly = choice == LightChoice::Uniform;
        all.choice = uniformly ? native::LightChoice::Uniform : native::LightChoice::Power;
        addColumns(lightTable(triangles, uniformly), all);
        return;
    }
    const LightTree tree = buildLightTree(std::move(triangles));
    all.choice = native::LightChoice::Tree;
    addColumns(tree.entries, all);
    for (const gpu::LightNode& node : tree.nodes)
        all.nodes.push_back(decoded(node));
}

native::LightKind kindOf(LightKind kind) {
    switch (kind) {
    case LightKind::Directional:
        return native::LightKind::Directional;
    case LightKind::Point:
        return native::LightKind::Point;
    case LightKind::Spot:
        return native::LightKind::Spot;
    default:
        return native::LightKind::Ambient;
    }
}

void addFileLight(const Light& l, EmbreeLights& all) {
    native::Light light{};
    light.kind = kindOf(l.kind);
    light.color = plain(l.color);
    light.position = plain(l.kind == LightKind::Directional ? -l.direction : l.position);
    light.edgeA = plain(l.direction);
    light.upperHemisphereOnly = l.upperHemisphereOnly;
    light.attenuation[0] = l.constantAttenuation;
    light.attenuation[1] = l.linearAttenuation;
    light.attenuation[2] = l.quadraticAttenuation;
    light.cosCutoff = std::cos(0.5f * l.falloffAngle);
    light.falloffExponent = l.falloffExponent;
    all.lights.push_back(light);
}

} // namespace

EmbreeLights embreeLights(const Scene& scene, LightChoice choice) {
    EmbreeLights all;
    const std::vector<Emitter> emitters = collectEmitters(scene);
    const bool many = haveManyTriangles(emitters);
    if (many) addManyTriangles(scene, emitters, choice, all);
    for (const Emitter& emitter : emitters)
        if (!many || emitter.kind == EmitterKind::Sphere) addEmitter(scene, emitter, all);
    for (const Light& light : scene.lights)
        if (!light.isDelta()) addFileLight(light, all);
    all.areaLights = uint32_t(all.lights.size());
    for (const Light& light : scene.lights)
        if (light.isDelta()) addFileLight(light, all);
    return all;
}

} // namespace stromboli::bench
