#include "host/kernel/recorded_path.hpp"

#include "shaders/shared/layer_types.h"
#include "shaders/shared/light_types.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli {
namespace {

double positive(float x) {
    return x > 0 ? double(x) : 0.0;
}

uint32_t inScene(uint32_t primitive, const GpuScene& scene) {
    return primitive == gpu::NO_NAME ? kNotNamed : scene.bvh.primitiveOrder.at(primitive);
}

/// A primitive that is the light; none of others than emissive geometry.
uint32_t primitiveOf(uint32_t reference, const GpuScene& scene) {
    const std::vector<uint32_t>& numbers = scene.lights.numberOf;
    for (uint32_t p = 0; p < numbers.size(); ++p)
        if (numbers[p] != gpu::NO_LIGHT &&
            structureAt<gpu::LightEntry>(scene.lights.table, numbers[p]).light == reference)
            return p;
    return kNotNamed;
}

std::string kindOfLight(uint32_t reference, const GpuScene& scene) {
#define NAME_LIGHT(name, number, rows, label) label,
    static constexpr auto kNames = std::to_array<const char*>({LIGHT_LIST(NAME_LIGHT)});
#undef NAME_LIGHT
    if (reference == gpu::NO_NAME) return "";
    if (reference & gpu::LIGHT_IS_TRIANGLE) return kNames[gpu::LIGHT_TRIANGLE];
    const bool onlyTriangles = scene.lights.sampledKinds == 1u << gpu::LIGHT_TRIANGLE;
    if (onlyTriangles) return kNames[gpu::LIGHT_TRIANGLE];
    const auto header =
        structureAt<gpu::LightHeader>(scene.lights.lights, size_t(gpu::LIGHT_ROWS) * reference);
    return kNames.at(header.kind & gpu::LIGHT_KIND_MASK);
}

RecordedVertex arrival(const gpu::PathEvent& e, const GpuScene& scene) {
    RecordedVertex v;
    v.primitive = inScene(e.name, scene);
    v.met = e.kind == gpu::EVENT_MISS  ? RecordedVertex::Met::Nothing
            : v.primitive == kNotNamed ? RecordedVertex::Met::Medium
                                       : RecordedVertex::Met::Surface;
    v.placement = e.placement == gpu::NO_SEEN_PLACEMENT ? kNotNamed : e.placement;
    if (v.met != RecordedVertex::Met::Nothing) {
        v.position = e.place;
        v.distance = double(e.distance);
    }
    v.direction = e.direction;
    v.throughput = e.throughput;
    v.weight = double(e.weight);
    v.light = e.light;
    v.goesOn = double(e.roulette);
    if (e.kind == gpu::EVENT_ARRIVAL) v.aimedWeight = double(e.pdf);
    return v;
}

RecordedLight lightSample(const gpu::PathEvent& e, const GpuScene& scene) {
    RecordedLight l;
    const bool tookNone = e.name != gpu::NO_NAME && e.pdf == 0;
    l.kind = tookNone ? kNoLight : kindOfLight(e.name, scene);
    if (e.name != gpu::NO_NAME && !tookNone) l.primitive = primitiveOf(e.name, scene);
    l.direction = e.direction;
    if (double(e.distance) < 1e30) l.distance = double(e.distance);
    l.pdf = positive(e.pdf);
    l.probability = positive(-e.pdf);
    l.weight = double(e.weight);
    l.fate = e.placement == 0 ? RecordedLight::Fate::BringsNothing
             : e.roulette > 0 ? RecordedLight::Fate::Arrives
                              : RecordedLight::Fate::InShadow;
    l.light = e.light;
    return l;
}

RecordedBounce bounce(const gpu::PathEvent& e) {
    RecordedBounce b;
    b.direction = e.direction;
    b.lobe = e.name;
    b.pdf = positive(e.pdf);
    b.weight = double(e.weight);
    b.throughput = e.throughput;
    b.goesOn = double(e.roulette);
    const double largest = std::max({b.throughput.x, b.throughput.y, b.throughput.z});
    b.survives = largest > 0 && (e.roulette >= 1 || e.distance < e.roulette);
    return b;
}

} // namespace

RecordedPath recordedPath(std::span<const gpu::PathEvent> events, uint32_t counted,
                          uint32_t branches, const GpuScene& scene) {
    RecordedPath path;
    path.branches = branches;
    path.isWhole = counted <= events.size();
    for (const gpu::PathEvent& e : events.first(std::min<size_t>(counted, events.size()))) {
        const uint32_t branch = e.branch == 0 ? 0 : branches - e.branch + 1;
        std::vector<RecordedVertex>& vertices = path.vertices;
        if (e.kind == gpu::EVENT_CAMERA) {
            path.origin = e.place;
            path.direction = e.direction;
            path.tMin = double(e.distance);
            path.filterWeight = double(e.weight);
        } else if (e.kind == gpu::EVENT_ARRIVAL || e.kind == gpu::EVENT_MISS) {
            vertices.push_back(arrival(e, scene));
            vertices.back().branch = branch;
        } else if (!vertices.empty() && e.kind == gpu::EVENT_LIGHT) {
            vertices.back().lights.push_back(lightSample(e, scene));
        } else if (!vertices.empty() && e.kind == gpu::EVENT_BOUNCE) {
            // A further branch leaves the surface at which the path has split.
            if (vertices.back().branch != branch && branch > 1) {
                RecordedVertex again;
                for (const RecordedVertex& v : vertices)
                    if (v.branch == 0) again = v;
                again.branch = branch;
                again.returns = true;
                again.light = glm::dvec3(0.0);
                again.lights.clear();
                vertices.push_back(std::move(again));
            }
            vertices.back().bounce = bounce(e);
        }
    }
    return path;
}

} // namespace stromboli
