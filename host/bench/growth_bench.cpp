#include "host/bench/growth_bench.hpp"

#include "host/bench/contestants.hpp"
#include "host/bench/ray_bench.hpp"
#include "host/bvh/wide_layout.hpp"
#include "host/core/stopwatch.hpp"

namespace stromboli::bench {

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
    point.bounce = benchRays(arena, rays, pair, bounce);
    return point;
}

} // namespace stromboli::bench
