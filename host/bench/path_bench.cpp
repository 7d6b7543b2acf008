#include "host/bench/path_bench.hpp"

#include "host/bench/painter.hpp"
#include "host/kernel/vulkan_backend.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::bench {
namespace {

/// Counting slows the kernel down, so it is done on the side, in another one.
double lanesBusy(const Arena& arena, const GpuScene& gpu) {
    KernelTuning tuning;
    tuning.countSteps = true;
    auto backend =
        std::make_unique<VulkanBackend>(arena.device, gpu, arena.camera, arena.settings, tuning);
    const VulkanBackend& counting = *backend;
    Painter painter("counting steps", std::move(backend), arena.settings);
    painter.goOn();
    const StepCounters steps = counting.steps();
    return steps.all > 0 ? double(steps.busy) / double(steps.all) : 0;
}

} // namespace

PathReport benchPaths(const Arena& arena, const GpuScene& gpu) {
    PathReport report;
    std::vector<Painter> painters;
    painters.emplace_back(
        "device", std::make_unique<VulkanBackend>(arena.device, gpu, arena.camera, arena.settings),
        arena.settings);
    report.contestants = race(painters, arena.plan);
    const RenderCounters counters = painters[0].backend().counters();
    report.raysPerPath = double(counters.rays) / double(std::max<uint64_t>(counters.paths, 1));
    if (arena.device.description().isCpu())
        report.driverBusy = report.contestants[0].parallelism() / arena.threads;
    report.lanesBusy = lanesBusy(arena, gpu);
    return report;
}

std::vector<KernelVariant> kernelVariants(const GpuScene& scene) {
    KernelTuning everything;
    everything.everythingOn = true;
    std::vector<KernelVariant> variants = {{"everything on", everything}};
    if (scene.hasPlacements)
        for (const uint32_t steps : {1u, 2u, 4u}) {
            KernelTuning legs;
            legs.traversalSteps = steps;
            legs.traversalLegs = 20 / steps;
            variants.push_back({fmt::format("legs of {}", steps), legs});
        }
    return variants;
}

VariantReport benchVariants(const Arena& arena, const GpuScene& gpu,
                            const std::vector<KernelVariant>& variants,
                            const std::string& ourName) {
    std::vector<Painter> painters;
    const auto add = [&](const std::string& name, const KernelTuning& tuning) {
        painters.emplace_back(name,
                              std::make_unique<VulkanBackend>(arena.device, gpu, arena.camera,
                                                              arena.settings, tuning),
                              arena.settings);
    };
    add(ourName, {});
    for (const KernelVariant& v : variants)
        add(v.name, v.tuning);
    VariantReport report;
    report.contestants = race(painters, arena.plan);
    for (size_t i = 1; i < painters.size(); ++i)
        report.samePicture.push_back(std::equal(
            painters[0].film().pixels.begin(), painters[0].film().pixels.end(),
            painters[i].film().pixels.begin(),
            [](const PixelStatistics& a, const PixelStatistics& b) { return a.mean == b.mean; }));
    return report;
}

} // namespace stromboli::bench
