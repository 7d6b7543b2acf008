#include "host/kernel/gap_proposal.hpp"

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
