#include "host/bench/embree_lights.hpp"

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/rows.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace stromboli::bench {
namespace {

native::TriangleLight triangleLight(const Scene& scene, uint32_t index) {
    const Triangle& t = scene.triangles[index];
    const glm::vec3 corner = scene.positions[t.corner[0]];
    const glm::vec3 a = scene.positions[t.corner[1]] - corner,
                    b = scene.positions[t.corner[2]] - corner;
    return {plain(corner),
            plain(a),
            plain(b),
            plain(scene.geometricNormal(t)),
            plain(scene.materials[t.material].emission),
            float(glm::length(glm::cross(glm::dvec3(a), glm::dvec3(b)))),
            scene.materials[t.material].emitsBothSides};
}

void decodeQuad(const gpu::QuadLight& q, native::Light& light) {
    light.position = plain(q.corner);
    light.edgeA = plain(q.edgeA);
    light.edgeB = plain(q.edgeB);
    light.area = q.area;
    light.normal =
        plain(glm::vec3(glm::normalize(glm::cross(glm::dvec3(q.edgeA), glm::dvec3(q.edgeB)))));
}

void decodePoint(const gpu::PointLight& p, native::Light& light) {
    light.position = plain(p.position);
    for (int i = 0; i < 3; ++i)
        light.attenuation[i] = p.attenuation[i];
    light.axis = plain(p.axis);
    light.cosCutoff = p.cosCutoff;
    light.falloffExponent = p.falloffExponent;
    light.softness = p.softness;
}

native::Light decodedLight(const std::vector<Row>& rows, size_t row) {
    const auto header = structureAt<gpu::LightHeader>(rows, row);
    native::Light light{};
    light.kind = header.kind & gpu::LIGHT_KIND_MASK;
    light.color = plain(header.color);
    light.bothSides = header.kind & gpu::LIGHT_BOTH_SIDES;
    switch (light.kind) {
    case gpu::LIGHT_QUAD:
        decodeQuad(structureAt<gpu::QuadLight>(rows, row + 1), light);
        break;
    case gpu::LIGHT_AMBIENT:
        light.fromAbove = plain(structureAt<gpu::AmbientLight>(rows, row + 1).fromAbove);
        break;
    case gpu::LIGHT_SPHERE: {
        const auto sphere = structureAt<gpu::SphereLight>(rows, row + 1);
        light.position = plain(sphere.center);
        light.radius = sphere.radius;
        break;
    }
    case gpu::LIGHT_DIRECTIONAL:
        light.position = plain(structureAt<gpu::DirectionalLight>(rows, row + 1).toLight);
        break;
    case gpu::LIGHT_POINT:
    case gpu::LIGHT_SPOT:
        decodePoint(structureAt<gpu::PointLight>(rows, row + 1), light);
        break;
    default:
        break;
    }
    return light;
}

native::LightNode decodedNode(const gpu::LightNode& n) {
    native::LightNode node{};
    node.center = plain(n.center);
    node.radius = std::bit_cast<float>(n.radiusAndPower & 0xFFFF0000u);
    node.axis = plain(decodeNormal(n.axis));
    node.cosSpread = n.cosSpread;
    node.sinSpread = std::sqrt(std::max(1 - n.cosSpread * n.cosSpread, 0.0f));
    node.power = std::bit_cast<float>(n.radiusAndPower << 16);
    node.bothSides = n.flags & gpu::LIGHT_NODE_BOTH_SIDES;
    node.sharp = n.flags & gpu::LIGHT_NODE_SHARP;
    return node;
}

gpu::LightNode nodeAt(const LightTable& table, size_t index) {
    const std::array<Row, 2> rows = {table.table[table.count + index],
                                     table.table[3 * size_t(table.count) + index]};
    return std::bit_cast<gpu::LightNode>(rows);
}

/// Both techniques have the density cos / pi by solid angle where the sky is alone: their MIS
/// weights by the power heuristic are the same everywhere.
float ambientOfBounces(const LightTable& table, const Estimator& settings) {
    if (table.ambientLeftToBounces) return 1;
    const bool skyAlone = table.sampledKinds == 1u << gpu::LIGHT_AMBIENT;
    if (!skyAlone || settings.directLight != DirectLight::Mis) return 0;
    const auto samples = float(settings.lightSamples);
    return 1 / (1 + samples * samples);
}

} // namespace

EmbreeLights embreeLights(const Scene& scene, const RenderSettings& settings) {
    std::vector<uint32_t> triangles(scene.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0);
    const LightTable table = packLights(scene, triangles, lightSelection(settings.estimator));
    EmbreeLights all;
    all.choice = lightChoiceConstant(table);
    all.lightsInGroup = table.lightsInGroup;
    all.areaLights = table.areaCount;
    all.hasAmbient = table.hasAmbient;
    all.direct = directSampling(table, settings.estimator);
    all.oneQuad =
        table.count == 1 && table.sampledKinds == 1u << gpu::LIGHT_QUAD && !table.hasAmbient;
    all.ambientOfBounces = ambientOfBounces(table, settings.estimator);
    constexpr uint32_t kWithoutCones = 1u << gpu::LIGHT_POINT | 1u << gpu::LIGHT_SPHERE;
    all.onlyNearWithoutCones =
        table.groups == 1u << gpu::LIGHT_GROUP_NEAR && (table.sampledKinds & ~kWithoutCones) == 0;
    for (size_t row = 0; row < table.lights.size(); row += gpu::LIGHT_ROWS)
        all.lights.push_back(decodedLight(table.lights, row));
    for (uint32_t i = 0; i < table.count; ++i) {
        const auto entry = structureAt<gpu::LightEntry>(table.table, i);
        const bool isTriangle = entry.light & gpu::LIGHT_IS_TRIANGLE;
        if (isTriangle)
            all.triangles.push_back(triangleLight(scene, entry.light & ~gpu::LIGHT_IS_TRIANGLE));
        const auto index = isTriangle ? uint32_t(all.triangles.size() - 1) : entry.light;
        all.entries.push_back({isTriangle, index, entry.probability});
    }
    if (table.groups)
        for (size_t i = 0; i < 2 * size_t(table.count); ++i)
            all.nodes.push_back(decodedNode(nodeAt(table, i)));
    else
        for (size_t row = table.count; row < table.table.size(); ++row) {
            const auto column = structureAt<gpu::AliasColumn>(table.table, row);
            all.columns.push_back({column.threshold, column.alias});
        }
    return all;
}

} // namespace stromboli::bench
