#include "host/bench/ray_bench.hpp"

#include "host/bench/measuring.hpp"
#include "host/bvh/binary_tree.hpp"
#include "host/bvh/cpu_traversal.hpp"
#include "host/bvh/leaf_items.hpp"
#include "host/bvh/statistics.hpp"
#include "host/bvh/wide_layout.hpp"
#include "host/core/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::bench {
namespace {

/// Relative; some hundred roundings of distances seen at a slant. A hit on another surface is
/// farther off, but where two of them meet.
constexpr float kSameDistance = 0x1p-14f;

bool isHit(float distance) {
    return distance < std::numeric_limits<float>::max();
}

bool agree(float a, float b, bool anyHit) {
    if (isHit(a) != isHit(b)) return false;
    if (!isHit(a) || anyHit) return true;
    return std::abs(a - b) <= kSameDistance * std::max(a, b);
}

/// Counts what rays visit, by the double of the kernel's traversal.
void countVisits(const WideLayout& layout, const RaySet& set, RayReport& report) {
    uint64_t nodes = 0, leaves = 0;
    for (const gpu::TracedRay& r : set.rays) {
        const TraversalRay ray{r.origin, r.direction, 0, r.tMax};
        TraversalCounts counts;
        if (set.anyHit)
            anyHit(layout, ray, &counts);
        else
            closestHit(layout, ray, &counts);
        nodes += counts.nodes;
        leaves += counts.leaves;
    }
    report.nodes = double(nodes) / double(set.rays.size());
    report.leaves = double(leaves) / double(set.rays.size());
}

} // namespace

double hitShare(const std::vector<float>& distances) {
    return double(std::count_if(distances.begin(), distances.end(), isHit)) /
           double(std::max<size_t>(distances.size(), 1));
}

uint64_t countDisagreements(const RaySet& set, const std::vector<float>& a,
                            const std::vector<float>& b) {
    uint64_t count = 0;
    for (size_t i = 0; i < a.size(); ++i)
        count += agree(a[i], b[i], set.anyHit) ? 0 : 1;
    return count;
}

RayReport benchRays(const Arena& arena, DeviceRays& device, const EmbreePair& embree,
                    const WideLayout& layout, const RaySet& set) {
    RayReport report;
    report.kind = set.name;
    report.rays = set.rays.size();
    if (set.rays.empty()) return report;
    device.load(set);
    const std::vector<float> distances = device.distances();
    report.hitShare = hitShare(distances);
    countVisits(layout, set, report);

    const auto rays = double(set.rays.size());
    std::vector<Contestant> contestants = {{"device", [&] {
                                                return Work{rays, device.trace().deviceSeconds};
                                            }}};
    const auto add = [&](const char* name, const EmbreeScene* scene) {
        if (!scene) return;
        report.disagreements.push_back(countDisagreements(set, distances, scene->distances(set)));
        contestants.push_back({name, [&set, scene, rays] {
                                   scene->trace(set);
                                   return Work{rays, 0};
                               }});
    };
    add("Embree fast", embree.fast.get());
    add("Embree robust", embree.robust.get());
    report.contestants = alternate(contestants, arena.plan);
    return report;
}

GrowthPoint benchSize(uint64_t triangles, const vulkan::Device& device, const Embree* embree,
                      uint32_t threads, const RenderSettings& settings, uint32_t raysPerPixel,
                      const AlternatePlan& plan) {
    const BenchScene scene = loadBenchScene("generate:cornell_mesh:" + std::to_string(triangles));
    const Arena arena = {device, embree, threads, plan, scene, cameraOf(scene, settings), settings};
    GrowthPoint point;
    point.scene = scene.name;
    point.triangles = scene.scene.triangles.size();
    const RaySet bounce =
        makeRaySets(scene.scene, arena.camera, arena.settings, raysPerPixel).bounce;
    const Stopwatch watch;
    WideLayout bvh = buildWideBvh(scene.scene);
    point.buildSeconds = watch.seconds();
    const EmbreePair pair = buildBest(arena, bounce);
    if (pair.fast) point.embreeBuildSeconds = pair.fast->buildSeconds;
    const GpuScene gpu = packScene(scene.scene, std::move(bvh));
    DeviceRays rays(device, gpu, rayTuning(device, rowBytes(gpu, bounce.rays.size())));
    point.bounce = benchRays(arena, rays, pair, gpu.bvh, bounce);
    return point;
}

BvhReport benchBvh(const Arena& arena) {
    const Scene& scene = arena.scene.scene;
    std::vector<Contestant> contestants = {{"ours", [&] {
                                                buildWideBvh(scene);
                                                return Work{};
                                            }}};
    uint64_t embreeBytes = 0;
    if (arena.embree) {
        const auto build = [&, geometry = arena.embree->geometry(scene)](EmbreeQuality quality) {
            // In its robust mode Embree builds the same whatever the quality.
            embreeBytes = arena.embree->build(geometry, EmbreeMode::Fast, quality)->bytes;
            return Work{};
        };
        contestants.push_back(
            {"Embree, medium quality", [build] { return build(EmbreeQuality::Medium); }});
        contestants.push_back(
            {"Embree, high quality", [build] { return build(EmbreeQuality::High); }});
    }
    contestants.push_back({"ours, binary tree alone", [&] {
                               buildBinaryTree(bvh::itemBounds(scene, bvh::makeLeafItems(scene)));
                               return Work{};
                           }});
    BvhReport report;
    report.builds = alternate(contestants, arena.plan);
    report.binaryTree = std::move(report.builds.back());
    report.builds.pop_back();
    const BvhStatistics statistics = measure(buildWideBvh(scene));
    report.expectedVisits = statistics.expectedVisits;
    report.bytesPerPrimitive = statistics.bytesPerPrimitive();
    const size_t primitives = scene.triangles.size() + scene.spheres.size();
    if (primitives > 0) report.embreeBytesPerPrimitive = double(embreeBytes) / double(primitives);
    return report;
}

} // namespace stromboli::bench
