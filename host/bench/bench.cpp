#include "host/bench/bench.hpp"

#include "host/bench/path_bench.hpp"
#include "host/bench/ray_bench.hpp"
#include "host/bench/report.hpp"
#include "host/bench/startup_bench.hpp"
#include "host/engine/load_scene.hpp"
#include "host/vulkan/device.hpp"
#include "scene/find_scene.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <thread>

namespace stromboli::bench {
namespace {

/// Camera rays a pixel: on a GPU enough to keep all of its lanes at work for some time, as a render
/// does.
constexpr uint32_t kRaysPerPixelCpu = 1, kRaysPerPixelGpu = 16;

class Benchmark {
  public:
    Benchmark(const BenchSettings& settings,
              const std::function<void(const std::string&)>& progress)
        : settings_(settings), progress_(progress),
          open_(vulkan::openDevice(settings.device, settings.messages)),
          threads_(threadsFor(settings)), embree_(openEmbree(threads_)) {}

    BenchReport run() {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads_);
        for (const std::string& name : settings_.scenes) // found out before the work, not after it
            sceneFile(name);
        BenchReport report;
        report.circumstances =
            circumstancesOf(open_.device->description(), embree_, threads_, settings_.commandLine);
        for (const std::string& name : settings_.scenes)
            report.scenes.push_back(benchScene(name));
        for (const uint64_t size : settings_.sizes)
            report.growth.push_back(benchSize(size, device(), embree_.embree.get(), threads_,
                                              renderSettings(), raysPerPixel(),
                                              plan("growing scene")));
        if (wants(Part::Startup)) report.startup = startup();
        if (wants(Part::Transfer)) report.transfer = benchTransfer(device(), plan("transfer"));
        vulkan::requireNoValidationMessages(open_);
        return report;
    }

  private:
    const vulkan::Device& device() const { return *open_.device; }
    bool wants(Part part) const { return settings_.parts.count(part) > 0; }

    uint32_t threadsFor(const BenchSettings& settings) const {
        if (settings.threads > 0) return settings.threads;
        const uint32_t ofDevice = deviceThreads(open_.device->description());
        return ofDevice > 0 ? ofDevice : std::max(1u, std::thread::hardware_concurrency());
    }

    uint32_t raysPerPixel() const {
        if (settings_.raysPerPixel > 0) return settings_.raysPerPixel;
        return device().description().isCpu() ? kRaysPerPixelCpu : kRaysPerPixelGpu;
    }

    RenderSettings renderSettings() const {
        RenderSettings s;
        s.area.width = settings_.width;
        s.area.height = settings_.height;
        s.budget.mostSamplesPerPixel = settings_.samplesPerPixel;
        s.estimator.maxBounces = settings_.maxBounces;
        s.estimator.seed = settings_.seed;
        s.estimator.sampler = settings_.sampler;
        s.estimator.gapProposal = false; // comparable with earlier figures
        return s;
    }

    AlternatePlan plan(const std::string& what) const {
        AlternatePlan p;
        p.repeats = settings_.repeats;
        p.leastSeconds = settings_.leastSeconds;
        if (progress_)
            p.progress = [this, what](const std::string& step) { progress_(what + ": " + step); };
        return p;
    }

    SceneReport benchScene(const std::string& name) {
        if (progress_) progress_(name + ": loading");
        const BenchScene scene = loadBenchScene(name);
        const RenderSettings settings = renderSettings();
        const Arena arena = {device(), embree_.embree.get(),      threads_, plan(name),
                             scene,    cameraOf(scene, settings), settings};
        SceneReport report = describe(scene, settings);
        if (wants(Part::Bvh)) report.bvh = benchBvh(arena);
        if (wants(Part::Rays) || wants(Part::Paths) || wants(Part::Variants)) trace(arena, report);
        if (wants(Part::Textures) && hasTextures(scene.scene))
            report.textures = benchTextures(arena);
        return report;
    }

    static SceneReport describe(const BenchScene& scene, const RenderSettings& settings) {
        SceneReport report;
        report.name = scene.name;
        report.triangles = scene.scene.placedTriangles();
        report.spheres = scene.scene.spheres.size();
        report.width = settings.area.width;
        report.height = settings.area.height;
        report.samplesPerPixel = settings.budget.mostSamplesPerPixel;
        report.maxBounces = settings.estimator.maxBounces;
        return report;
    }

    void traceRays(const Arena& arena, const GpuScene& gpu, SceneReport& report) {
        if (progress_) progress_(arena.scene.name + ": making rays");
        const Scene& scene = arena.scene.scene;
        const RaySets sets =
            scene.placements.empty()
                ? makeRaySets(scene, arena.camera, arena.settings, raysPerPixel())
                : makePlacedRaySets(scene, gpu.bvh, arena.camera, arena.settings, raysPerPixel());
        const EmbreePair embree = buildBest(arena, sets.bounce);
        if (embree.fast) report.embreeQuality = nameOf(embree.quality);
        DeviceRays rays(device(), gpu, rayTuning(device(), rowBytes(gpu, sets.largest())));
        for (const RaySet* set : {&sets.camera, &sets.shadow, &sets.bounce})
            report.rays.push_back(benchRays(arena, rays, embree, gpu.bvh, *set));
    }

    /// All that needs a device's copy of the scene.
    void trace(const Arena& arena, SceneReport& report) {
        const Scene& scene = arena.scene.scene;
        GpuScene gpu = buildScene(scene, arena.settings.estimator).gpu;
        fitToPicture(gpu, scene, arena.camera, arena.settings.estimator);
        if (wants(Part::Rays)) traceRays(arena, gpu, report);
        if (wants(Part::Paths)) report.paths = benchPaths(arena, gpu);
        if (wants(Part::Variants)) report.variants = benchVariants(arena, gpu, kernelVariants(gpu));
    }

    /// Measures start-up with the first scene that is a file; empty if none is.
    std::optional<StartupReport> startup() {
        for (const std::string& name : settings_.scenes)
            if (const std::string file = sceneFile(name); !file.empty())
                return benchStartup(settings_.program, file, settings_.device, plan("start-up"));
        return {};
    }

    const BenchSettings& settings_;
    const std::function<void(const std::string&)>& progress_;
    vulkan::OpenDevice open_;
    uint32_t threads_;
    OpenedEmbree embree_;
};

} // namespace

std::set<Part> allParts() {
    std::set<Part> parts;
    for (const NamedValue<Part>& row : kNamedValues<Part>)
        parts.insert(row.value);
    return parts;
}

BenchReport runBench(const BenchSettings& settings,
                     const std::function<void(const std::string&)>& progress) {
    return Benchmark(settings, progress).run();
}

} // namespace stromboli::bench
