#include "host/kernel/feelers.hpp"

#include "host/bvh/cpu_traversal.hpp"
#include "host/kernel/lamp_light.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace stromboli {
namespace {

/// Surfaces that a feeler goes through at most.
constexpr int kMostPanes = 16;

Feeler feel(const WideLayout& bvh, TraversalRay ray, const SeesThrough& seesThrough) {
    Feeler f{ray.origin, ray.direction};
    TraversalCounts counts;
    TraversalHit hit = closestHit(bvh, ray, &counts);
    for (int i = 0; i < kMostPanes && hit && seesThrough && seesThrough(hit.primitive); ++i) {
        goThrough(bvh, ray, hit);
        hit = closestHit(bvh, ray, &counts);
    }
    f.visited = counts.nodes + counts.leaves;
    f.spheres = counts.spheres;
    if (!hit) return f;
    f.isFree = false;
    f.met = ray.origin + hit.t * (1 - 0x1p-12f) * ray.direction;
    if (const auto c = cornersAt(bvh, hit)) {
        const glm::vec3 n = glm::cross((*c)[1] - (*c)[0], (*c)[2] - (*c)[0]);
        const float length = glm::length(n);
        if (length > 0) f.normal = (glm::dot(n, ray.direction) > 0 ? -n : n) / length;
    }
    return f;
}

Feelers feelAll(const WideLayout& bvh, std::span<const TraversalRay> rays,
                const SeesThrough& seesThrough) {
    Feelers felt(rays.size());
    tbb::parallel_for(size_t(0), rays.size(),
                      [&](size_t i) { felt[i] = feel(bvh, rays[i], seesThrough); });
    return felt;
}

} // namespace

Feelers lookAround(const WideLayout& bvh, const Camera& camera, uint32_t side,
                   const SeesThrough& seesThrough) {
    std::vector<TraversalRay> rays(size_t(side) * side);
    for (size_t i = 0; i < rays.size(); ++i) {
        const glm::dvec2 at((double(i % side) + 0.5) / side * 2 - 1,
                            (double(i / side) + 0.5) / side * 2 - 1);
        const glm::dvec3 offset =
            at.x * camera.halfWidth * camera.right + at.y * camera.halfHeight * camera.up;
        rays[i].origin = camera.orthographic ? camera.position + offset : camera.position;
        rays[i].direction =
            glm::normalize(camera.orthographic ? -camera.back : offset - camera.backOfMiddle());
    }
    Feelers seen = feelAll(bvh, rays, seesThrough);
    std::erase_if(seen, [](const Feeler& f) { return f.isFree; });
    return seen;
}

Feelers feelFrom(const WideLayout& bvh, std::span<const Feeler> ended, size_t each, Random& random,
                 const SeesThrough& seesThrough) {
    std::vector<TraversalRay> rays;
    for (const Feeler& f : ended)
        for (size_t k = 0; k < each && !f.isFree; ++k) {
            TraversalRay ray;
            ray.origin = f.met;
            ray.direction = random.direction();
            const glm::vec3 side = f.normal == glm::vec3(0) ? -f.direction : f.normal;
            if (glm::dot(ray.direction, side) < 0) ray.direction = -ray.direction;
            rays.push_back(ray);
        }
    return feelAll(bvh, rays, seesThrough);
}

VisitsOfRay visitsOfRay(const WideLayout& bvh, const Camera& camera) {
    constexpr uint32_t kSide = 12;
    constexpr size_t kEach = 2;
    Random random(1);
    const Feelers seen = lookAround(bvh, camera, kSide);
    const Feelers once = feelFrom(bvh, seen, kEach, random);
    const Feelers twice = feelFrom(bvh, once, 1, random);
    uint64_t visited = 0, spheres = 0;
    for (const Feelers* feelers : {&seen, &once, &twice})
        for (const Feeler& f : *feelers)
            visited += f.visited, spheres += f.spheres;
    const size_t rays = seen.size() + once.size() + twice.size();
    if (rays == 0) return {};
    return {double(visited) / double(rays), double(spheres) / double(rays)};
}

std::optional<double> shareOfFree(std::span<const Feeler> feelers) {
    if (feelers.empty()) return std::nullopt;
    return double(std::ranges::count(feelers, true, &Feeler::isFree)) / double(feelers.size());
}

} // namespace stromboli
