#include "host/bench/path_bench.hpp"

#include "host/bench/painter.hpp"
#include "host/check/cross_check.hpp"
#include "host/kernel/vulkan_backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace stromboli::bench {
namespace {

/// Share of the pixels whose means differ by less than a path tracer in float may put on them.
double equalPixels(const Film& a, const Film& b) {
    constexpr double tolerance = 0x1p-10; // relative
    size_t equal = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 &x = a.pixels[i].mean, &y = b.pixels[i].mean;
        equal += glm::length(x - y) <= tolerance * glm::length(x) ? 1 : 0;
    }
    return double(equal) / double(std::max<size_t>(a.pixels.size(), 1));
}

void comparePictures(const std::vector<Painter>& painters, PathReport& report) {
    if (painters.size() < 2) return;
    report.picturesAgree = true;
    report.equalPixels = 1;
    for (size_t i = 1; i < painters.size(); ++i) {
        const CheckResult check = crossCheck(painters[0].film(), painters[i].film());
        report.equalPixels =
            std::min(report.equalPixels, equalPixels(painters[0].film(), painters[i].film()));
        if (check.agree()) continue;
        report.picturesAgree = false;
        report.disagreement += painters[i].name() + "\n" + formatCheck(check);
    }
}

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

/// Why there is no path tracer on Embree for this scene; empty if there is one.
std::string whyNoEmbree(const Arena& arena, const EmbreePair& embree) {
    if (!embree.fast) return "there is no Embree";
    const std::string lacking = embreePathsLack(arena.scene.scene, arena.settings);
    return lacking.empty() ? "" : "its path tracer has no " + lacking;
}

} // namespace

PathReport benchPaths(const Arena& arena, const GpuScene& gpu, const EmbreePair& embree) {
    PathReport report;
    const Scene& scene = arena.scene.scene;
    std::vector<Painter> painters;
    painters.emplace_back(
        "device", std::make_unique<VulkanBackend>(arena.device, gpu, arena.camera, arena.settings),
        arena.settings);
    report.embreeMissing = whyNoEmbree(arena, embree);
    if (report.embreeMissing.empty()) {
        painters.emplace_back("Embree fast",
                              embree.fast->pathTracer(scene, arena.camera, arena.settings),
                              arena.settings);
        painters.emplace_back("Embree robust",
                              embree.robust->pathTracer(scene, arena.camera, arena.settings),
                              arena.settings);
    }
    report.contestants = race(painters, arena.plan);
    const RenderCounters counters = painters[0].backend().counters();
    report.raysPerPath = double(counters.rays) / double(std::max<uint64_t>(counters.paths, 1));
    if (arena.device.description().isCpu())
        report.driverBusy = report.contestants[0].parallelism() / arena.threads;
    report.lanesBusy = lanesBusy(arena, gpu);
    comparePictures(painters, report);
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
