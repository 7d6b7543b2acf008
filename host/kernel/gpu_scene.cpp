#include "host/kernel/gpu_scene.hpp"

#include "host/bvh/cpu_traversal.hpp"
#include "host/kernel/detail_rows.hpp"
#include "host/kernel/lamp_light.hpp"
#include "host/kernel/medium_rows.hpp"
#include "scene/model/mixture.hpp"
#include "shaders/shared/interface.h"
#include "shaders/shared/medium_types.h"
#include "shaders/shared/texture_types.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace stromboli {

// --- The scene -----------------------------------------------------------------------------------

namespace {

glm::uvec3 normalWords(const Scene& scene, const Triangle& t) {
    const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                     c = scene.positions[t.corner[2]];
    return glm::floatBitsToUint(glm::vec3(glm::normalize(glm::cross(b - a, c - a))));
}

/// firstCorner: the corner of the file that the leaf has first.
gpu::Primitive packTriangle(const Scene& scene, const Triangle& t, uint32_t materialRow,
                            uint32_t firstCorner) {
    if (t.normals[0] == kNoNormals) {
        const glm::uvec3 n = normalWords(scene, t);
        return {materialRow, n.x, n.y, n.z};
    }
    const auto normal = [&](uint32_t c) {
        return encodeNormal(scene.normals[t.normals[(c + firstCorner) % 3]]);
    };
    return {materialRow | gpu::PRIMITIVE_IS_SMOOTH, normal(0), normal(1), normal(2)};
}

/// By material: whether a primitive has it, or one that it may take the place of.
std::vector<bool> usedMaterials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Triangle& t : scene.triangles)
        used[t.material] = true;
    for (const Sphere& s : scene.spheres)
        used[s.material] = true;
    for (uint32_t i = 0; i < used.size(); ++i)
        if (used[i] && scene.materials[i].other != kNoMaterial)
            for (const uint32_t part : materialsOfMixture(scene.materials, i))
                used[part] = true;
    return used;
}

/// Appends the pictures of lights to the rows of materials; by light, the first row of its picture.
std::vector<uint32_t> appendPictures(std::vector<Row>& materials,
                                     const std::vector<std::vector<Row>>& pictures) {
    std::vector<uint32_t> firstRow;
    for (const std::vector<Row>& rows : pictures) {
        firstRow.push_back(rows.empty() ? 0 : uint32_t(materials.size()));
        materials.insert(materials.end(), rows.begin(), rows.end());
    }
    return firstRow;
}

void packPrimitives(const Scene& scene, const std::vector<uint32_t>& materialRow, GpuScene& g) {
    const auto triangles = uint32_t(scene.triangles.size());
    g.primitives.clear();
    g.closures = {};
    g.hasNormals = g.hasEmission = g.hasBlackBacks = g.hasReliefRules = false;
    g.hasDispersion = g.hasIridescence = false;
    g.hasTriangles = triangles > 0;
    g.hasSpheres = !scene.spheres.empty();
    g.hasPlacements = !scene.placements.empty();
    g.primitives.reserve(g.bvh.primitiveOrder.size());
    for (const uint32_t id : g.bvh.primitiveOrder) {
        const uint32_t material =
            id < triangles ? scene.triangles[id].material : scene.spheres[id - triangles].material;
        const uint32_t row = materialRow[material];
        g.primitives.push_back(
            id < triangles ? packTriangle(scene, scene.triangles[id], row, g.bvh.firstCorner[id])
                           : gpu::Primitive{row, 0, 0, 0});
        g.hasNormals |= (g.primitives.back().material & gpu::PRIMITIVE_IS_SMOOTH) != 0;
    }
    const std::vector<bool> used = usedMaterials(scene);
    for (size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        g.closures.add(closureBits(scene.materials[i]));
        g.hasEmission |= scene.materials[i].emits();
        g.hasBlackBacks |= scene.materials[i].isBlackBehind;
        g.hasReliefRules |=
            reliefBits(scene.materials[i]) != 0 || scene.materials[i].mirrorsReliefBehind;
        g.hasDispersion |= isDispersive(scene.materials[i]);
        g.hasIridescence |= isIridescent(scene.materials[i]);
    }
}

void nameLight(GpuScene& g, size_t primitive, uint32_t number) {
    const uint32_t place = g.bvh.placeOf[primitive];
    gpu::LeafRecord leaf = asLeaf(g.bvh.records[place / 2]);
    (place % 2 == 0 ? leaf.light0 : leaf.light1) = number;
    g.bvh.records[place / 2] = std::bit_cast<Record>(leaf);
}

/// Tells the leaves of the tree which lights they are. before: as they were told the last time.
/// Returns whether any of them is another one now.
bool nameLights(GpuScene& g, std::span<const uint32_t> before = {}) {
    bool anyChanged = false;
    for (size_t id = 0; id < std::max(before.size(), g.lights.numberOf.size()); ++id) {
        const uint32_t old = id < before.size() ? before[id] : gpu::NO_LIGHT;
        const uint32_t number =
            id < g.lights.numberOf.size() ? g.lights.numberOf[id] : gpu::NO_LIGHT;
        if (number == old) continue;
        nameLight(g, id, number);
        anyChanged = true;
    }
    return anyChanged;
}

/// before: as packScene() has it.
void packTextures(GpuScene& g, const Scene& scene, DetailPlan plan, const GpuScene* before) {
    g.details = before && before->detailPlan == plan
                    ? repackAttributes(scene, g.bvh, plan.attributes, before->details)
                    : packDetails(scene, g.bvh, plan);
    g.textureSlots = plan.textureSlots, g.looseSlots = plan.looseSlots;
    g.texelKinds = plan.texelKinds;
    g.attributes = plan.attributes, g.hasAlpha = plan.hasAlpha, g.hasHidden = plan.hasHidden;
    g.mostTextures = plan.mostTextures;
    g.hasBlends = plan.hasBlends;
    g.hasTangentFrames = plan.hasTangentFrames;
    g.detailPlan = std::move(plan);
}

bool hasSky(const Scene& scene) {
    const auto isAmbient = [](const Light& l) { return l.kind == LightKind::Ambient; };
    return scene.environment || std::ranges::any_of(scene.lights, isAmbient);
}

/// All of a scene but its tree and its textures.
void packRest(GpuScene& g, const Scene& scene, const LightSelection& lights,
              std::shared_ptr<const EnvironmentTable> environment) {
    MaterialRows materials = packMaterials(scene.materials, g.details.ofMaterials, scene.media);
    g.materials = std::move(materials.rows);
    g.mostOthers = materials.mostOthers, g.mostBlends = materials.mostBlends;
    packPrimitives(scene, materials.firstRow, g);
    g.media = materials.media.kinds;
    g.mediumRow = std::move(materials.media.firstRow);
    for (const uint32_t closures : materials.media.closures)
        g.closures.add(closures);
    g.lit.reset();
    // Samples that media take within the glass would find the lamp; beside a sky nothing is gained.
    const bool leaves = lights.leavesLampsInGlass && scene.media.empty() && !hasSky(scene);
    g.lights = packLights(scene, g.bvh.placeOf, lights,
                          appendPictures(g.materials, g.details.ofLights), std::move(environment),
                          leaves ? lampsInGlass(scene, g.bvh) : std::vector<bool>());
    const LightFoci foci = lightFoci(scene);
    appendFoci(g.materials, scene.media, g.mediumRow, foci);
    g.foci = uint32_t(foci.near.size());
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

GpuScene packScene(const Scene& scene, WideLayout bvh, const LightSelection& lights,
                   std::shared_ptr<const EnvironmentTable> environment, uint64_t gatheredRows,
                   const GpuScene* before) {
    GpuScene g;
    g.bvh = std::move(bvh);
    packTextures(g, scene, planDetails(scene, usedMaterials(scene), gatheredRows), before);
    packRest(g, scene, lights, std::move(environment));
    nameLights(g);
    // Beside lights that are geometry: a rectangle that is none has its own mesh close by.
    if (lights.emitters) g.gapWidth = gapWidth(g);
    return g;
}

bool differInNumbers(const Material& a, const Material& b) {
    return a.kind == b.kind && a.alphaMode == b.alphaMode && a.opacity == b.opacity &&
           a.alphaCutoff == b.alphaCutoff && a.other == b.other && a.otherShare == b.otherShare &&
           a.otherPlace == b.otherPlace && a.isHiddenFromCamera == b.isHiddenFromCamera &&
           a.boundsMedia == b.boundsMedia && a.inside == b.inside && a.outside == b.outside &&
           a.textures == b.textures;
}

bool wantsOtherTextures(const GpuScene& packed, const Scene& scene, uint64_t gatheredRows) {
    return planDetails(scene, usedMaterials(scene), gatheredRows) != packed.detailPlan;
}

std::vector<uint32_t> repackMaterials(GpuScene& packed, const Scene& scene,
                                      const LightSelection& lights, bool hasOtherEnvironment) {
    const std::vector<Row> materials = std::move(packed.materials);
    const std::vector<gpu::Primitive> primitives = std::move(packed.primitives);
    const LightTable before = std::move(packed.lights);
    packRest(packed, scene, lights, hasOtherEnvironment ? nullptr : before.environment);
    std::vector<uint32_t> changed;
    if (hasOtherEnvironment) changed.push_back(BINDING_ENVIRONMENT);
    const auto differ = [](const auto& a, const auto& b) {
        return !std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
    };
    if (nameLights(packed, before.numberOf)) changed.push_back(BINDING_RECORDS);
    if (differ(primitives, packed.primitives)) changed.push_back(BINDING_PRIMITIVES);
    if (differ(materials, packed.materials)) changed.push_back(BINDING_MATERIALS);
    if (differ(before.lights, packed.lights.lights)) changed.push_back(BINDING_LIGHTS);
    if (differ(before.table, packed.lights.table)) changed.push_back(BINDING_LIGHT_TABLE);
    packed.gapWidth = lights.emitters ? gapWidth(packed) : 0;
    return changed;
}

std::vector<uint32_t> turnEnvironment(GpuScene& packed, float rotation) {
    turnEnvironment(packed.lights, rotation);
    return {BINDING_LIGHTS};
}

// --- The gap -------------------------------------------------------------------------------------

namespace {

constexpr int kProbesPerEdge = 8;
/// Share of the probes that have to find the surface.
constexpr double kLeastShare = 0.75;
/// Gaps, in units of the light's shorter edge. Wider ones are found by bounces well enough
/// (docs/results.md); narrower ones are not told from the light itself.
constexpr float kWidest = 0.25f, kNarrowest = 0x1p-12f;

/// Or nearly: the kernel squares it up, and what it misses of the rims is left to the other
/// bounces.
bool isRectangle(const gpu::QuadLight& light) {
    const float a = glm::length(light.edgeA), b = glm::length(light.edgeB);
    return std::abs(glm::dot(light.edgeA, light.edgeB)) <= 1e-3f * a * b;
}

bool isDiffuse(const GpuScene& scene, uint32_t place) {
    const gpu::LeafRecord leaf = asLeaf(scene.bvh.records[place / 2]);
    const uint32_t primitive = (leaf.primitive & gpu::RECORD_INDEX_MASK) + place % 2;
    const gpu::Primitive& p = scene.primitives[primitive];
    const uint32_t closures = materialHeader(scene, p).closures;
    if (!(closures & gpu::CLOSURE_BASE) || (closures & gpu::CLOSURE_INTERFACE)) return false;
    const auto color = structureAt<glm::vec4>(scene.materials, materialOf(p) + 1);
    return glm::any(glm::greaterThan(glm::vec3(color), glm::vec3(0)));
}

/// The median distance of what probes from the light along n (unit) find, if enough find something.
std::optional<float> gapAlong(const GpuScene& scene, const gpu::QuadLight& light,
                              const glm::vec3& n) {
    const float edge = std::min(glm::length(light.edgeA), glm::length(light.edgeB));
    std::vector<float> found;
    for (int i = 0; i < kProbesPerEdge; ++i)
        for (int j = 0; j < kProbesPerEdge; ++j) {
            const float a = (float(i) + 0.5f) / kProbesPerEdge,
                        b = (float(j) + 0.5f) / kProbesPerEdge;
            const glm::vec3 origin = light.corner + a * light.edgeA + b * light.edgeB;
            const TraversalHit hit = closestHit(scene.bvh, {.origin = origin,
                                                            .direction = n,
                                                            .tMin = kNarrowest * edge,
                                                            .tMax = kWidest * edge});
            if (hit && isDiffuse(scene, hit.primitive)) found.push_back(hit.t);
        }
    if (double(found.size()) < kLeastShare * kProbesPerEdge * kProbesPerEdge) return {};
    const auto middle = found.begin() + long(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    return *middle;
}

} // namespace

float gapWidth(const GpuScene& scene) {
    if (scene.lights.count != 1 || scene.lights.sampledKinds != 1u << gpu::LIGHT_QUAD) return 0;
    if (!scene.lights.leftToBounces.empty()) return 0; // the aimed bounces find them
    // Ambient light that is left to bounces lies before it.
    const size_t row = gpu::LIGHT_ROWS * structureAt<gpu::LightEntry>(scene.lights.table, 0).light;
    const auto header = structureAt<gpu::LightHeader>(scene.lights.lights, row);
    const auto light = structureAt<gpu::QuadLight>(scene.lights.lights, row + 1);
    if (!isRectangle(light)) return 0;
    // In double: the square of an area leaves the range of float.
    const glm::vec3 n =
        glm::normalize(glm::cross(glm::dvec3(light.edgeA), glm::dvec3(light.edgeB)));
    const std::optional<float> front = gapAlong(scene, light, n);
    if (front) return *front;
    const bool bothSides = header.kind & gpu::LIGHT_BOTH_SIDES;
    return bothSides ? -gapAlong(scene, light, -n).value_or(0) : 0;
}

} // namespace stromboli
