#include "host/bench/robustness_bench.hpp"

#include "host/bench/device_rays.hpp"
#include "host/bench/path_bench.hpp"
#include "host/bench/plain_kernels.hpp"
#include "host/bench/ray_bench.hpp"
#include "host/kernel/kernel_buffers.hpp"

#include <list>

namespace stromboli::bench {
namespace {

/// All on the device; the disagreements are those of the plain kernels with the robust one.
RayReport benchPlainRays(const Arena& arena, const GpuScene& gpu, const RaySet& set) {
    RayReport report;
    report.kind = set.name;
    report.rays = set.rays.size();
    if (set.rays.empty()) return report;
    const RayTuning tuning = rayTuning(arena.device, rowBytes(gpu, set.rays.size()));
    std::list<DeviceRays> kernels; // which stay where they are
    std::vector<Contestant> contestants;
    const auto add = [&](const std::string& name, std::span<const uint32_t> code) {
        DeviceRays& kernel = kernels.emplace_back(arena.device, gpu, tuning, code);
        kernel.load(set);
        contestants.push_back({name, [&kernel, rays = double(set.rays.size())] {
                                   return Work{rays, kernel.trace().deviceSeconds};
                               }});
    };
    add("robust", {});
    for (const PlainKernel& plain : plainRayKernels())
        add(plain.name, plain.code(tuning.kernel.texelFetch));
    const std::vector<float> right = kernels.front().distances();
    report.hitShare = hitShare(right);
    for (auto plain = std::next(kernels.begin()); plain != kernels.end(); ++plain)
        report.disagreements.push_back(countDisagreements(set, right, plain->distances()));
    report.contestants = alternate(contestants, arena.plan);
    return report;
}

std::vector<KernelVariant> plainPathVariants(const Arena& arena, const GpuScene& gpu) {
    std::vector<KernelVariant> variants;
    const bool texelFetch =
        resolve({}, arena.device, largestRowBuffer(gpu, arena.settings.area.pixelCount()))
            .texelFetch;
    for (const PlainKernel& plain : plainPathKernels()) {
        KernelTuning tuning;
        tuning.code = plain.code(texelFetch);
        variants.push_back({plain.name, tuning});
    }
    return variants;
}

} // namespace

RobustnessReport benchRobustness(const Arena& arena, const GpuScene& gpu, const RaySets& sets) {
    RobustnessReport report;
    for (const RaySet* set : {&sets.camera, &sets.shadow, &sets.bounce})
        report.rays.push_back(benchPlainRays(arena, gpu, *set));
    report.paths = benchVariants(arena, gpu, plainPathVariants(arena, gpu), "robust").contestants;
    return report;
}

} // namespace stromboli::bench
