#include "host/kernel/lamp_gap.hpp"

#include "host/bvh/cpu_traversal.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace stromboli {
namespace {

constexpr int kProbesPerEdge = 8;
/// Share of the probes that have to find the surface.
constexpr double kLeastShare = 0.75;
/// Gaps, in units of the lamp's shorter edge. Wider ones are found by bounces well enough
/// (docs/estimator.md); narrower ones are not told from the lamp itself.
constexpr float kWidest = 0.25f, kNarrowest = 0x1p-12f;

/// Or nearly: the kernel squares it up, and what it misses of the rims is left to the other
/// bounces.
bool isRectangle(const gpu::Light& lamp) {
    const float a = glm::length(lamp.edgeA), b = glm::length(lamp.edgeB);
    return std::abs(glm::dot(lamp.edgeA, lamp.edgeB)) <= 1e-3f * a * b;
}

bool isDiffuse(const GpuScene& scene, uint32_t place) {
    const gpu::LeafRecord leaf = asLeaf(scene.bvh.records[place / 2]);
    const uint32_t primitive = (leaf.primitive & gpu::RECORD_INDEX_MASK) + place % 2;
    const gpu::Material& m = scene.materials[materialOf(scene.primitives[primitive])];
    return m.kind == gpu::MATERIAL_DIFFUSE &&
           glm::any(glm::greaterThan(m.reflectance, glm::vec3(0)));
}

/// The median distance of what probes from the lamp along n (unit) find, if enough find something.
std::optional<float> gapAlong(const GpuScene& scene, const gpu::Light& lamp, const glm::vec3& n) {
    const float edge = std::min(glm::length(lamp.edgeA), glm::length(lamp.edgeB));
    std::vector<float> found;
    for (int i = 0; i < kProbesPerEdge; ++i)
        for (int j = 0; j < kProbesPerEdge; ++j) {
            const float a = (float(i) + 0.5f) / kProbesPerEdge,
                        b = (float(j) + 0.5f) / kProbesPerEdge;
            const glm::vec3 origin = lamp.position + a * lamp.edgeA + b * lamp.edgeB;
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

float lampGap(const GpuScene& scene) {
    if (scene.lights.size() != 1 || scene.lights[0].kind != gpu::LIGHT_QUAD) return 0;
    const gpu::Light& lamp = scene.lights[0];
    if (!isRectangle(lamp)) return 0;
    // In double: the square of an area leaves the range of float.
    const glm::vec3 n = glm::normalize(glm::cross(glm::dvec3(lamp.edgeA), glm::dvec3(lamp.edgeB)));
    const std::optional<float> front = gapAlong(scene, lamp, n);
    if (front) return *front;
    return lamp.bothSides != 0 ? -gapAlong(scene, lamp, -n).value_or(0) : 0;
}

} // namespace stromboli
