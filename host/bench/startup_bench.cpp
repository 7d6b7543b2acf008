#include "host/bench/startup_bench.hpp"

#include "host/bench/child_process.hpp"
#include "host/core/error.hpp"
#include "host/core/stopwatch.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/render.hpp"
#include "host/vulkan/open_device.hpp"
#include "scene/read_scene.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <optional>
#include <sstream>

namespace stromboli::bench {
namespace {

constexpr uint32_t kSide = 64; ///< pixels

using Stages = StartupReport::Stages;

/// In the order in which they happen.
constexpr double Stages::*kStages[] = {&Stages::device,        &Stages::load,
                                       &Stages::build,         &Stages::pipeline,
                                       &Stages::firstDispatch, &Stages::secondDispatch};

/// Sends all caches that matter to one folder: ours, Mesa's and NVIDIA's.
Environment cachesIn(const std::filesystem::path& folder) {
    return {{"STROMBOLI_CACHE_DIR", (folder / "stromboli").string()},
            {"MESA_SHADER_CACHE_DIR", (folder / "mesa").string()},
            {"__GL_SHADER_DISK_CACHE_PATH", folder.string()}};
}

/// A program that is started over and over with empty caches, or with those of the run before.
class Starter {
  public:
    explicit Starter(std::vector<std::string> command) : command_(std::move(command)) {}

    std::string cold() const {
        const ScratchFolder caches;
        return runProgram(command_, cachesIn(caches.path()));
    }
    std::string warm() const { return runProgram(command_, cachesIn(warmCaches_.path())); }

  private:
    std::vector<std::string> command_;
    ScratchFolder warmCaches_;
};

Stages medianOf(const std::vector<Stages>& runs) {
    Stages medians;
    for (const auto stage : kStages) {
        std::vector<double> values;
        for (const Stages& run : runs)
            values.push_back(run.*stage);
        medians.*stage = spreadOf(values).median;
    }
    return medians;
}

void addDevice(std::vector<std::string>& command, const std::string& device) {
    if (!device.empty()) command.insert(command.end(), {"--device", device});
}

} // namespace

StartupReport benchStartup(const std::string& program, const std::string& sceneFile,
                           const std::string& device, const AlternatePlan& plan) {
    const ScratchFolder pictures;
    const std::string side = std::to_string(kSide);
    std::vector<std::string> render = {program,
                                       "render",
                                       sceneFile,
                                       "-q",
                                       "-s",
                                       "1",
                                       "-r",
                                       side,
                                       side,
                                       "-o",
                                       (pictures.path() / "a.png").string()};
    std::vector<std::string> probe = {program, "bench", "--probe-startup", sceneFile};
    addDevice(render, device);
    addDevice(probe, device);
    const Starter rendering(render), probing(probe);

    AlternatePlan once = plan;
    once.leastSeconds = 0;
    std::vector<Stages> cold, warm;
    const auto run = [](const auto& start) {
        return [&start] {
            start();
            return Work{};
        };
    };
    const auto renderCold = [&] { rendering.cold(); };
    const auto renderWarm = [&] { rendering.warm(); };
    const auto probeCold = [&] { cold.push_back(stagesFrom(probing.cold())); };
    const auto probeWarm = [&] { warm.push_back(stagesFrom(probing.warm())); };
    std::vector<Series> series = alternate({{"start, cold caches", run(renderCold)},
                                            {"start, warm caches", run(renderWarm)},
                                            {"stages, cold caches", run(probeCold)},
                                            {"stages, warm caches", run(probeWarm)}},
                                           once);
    series.resize(2);
    warm.erase(warm.begin()); // that run filled the caches
    return {std::move(series), medianOf(cold), medianOf(warm)};
}

Stages probeStartup(const std::string& sceneFile, const std::string& device) {
    Stages stages;
    Stopwatch watch;
    const auto lap = [&](double Stages::*stage) {
        stages.*stage = watch.seconds();
        watch = {};
    };
    const vulkan::OpenDevice open = vulkan::openDevice(device);
    lap(&Stages::device);
    const Scene scene = readScene(sceneFile);
    lap(&Stages::load);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(Estimator{}));
    lap(&Stages::build);
    RenderSettings settings;
    settings.area.width = settings.area.height = kSide;
    settings.budget.mostSamplesPerPixel = 1;
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, kSide, kSide);
    VulkanBackend backend(*open.device, gpu, camera, settings);
    lap(&Stages::pipeline);
    Film film = render(backend, settings);
    lap(&Stages::firstDispatch);
    std::vector<PixelTarget> again;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel)
        again.push_back({pixel, 2});
    backend.sample(again, film, {});
    lap(&Stages::secondDispatch);
    return stages;
}

std::string toText(const Stages& stages) {
    std::vector<double> values;
    for (const auto stage : kStages)
        values.push_back(stages.*stage);
    return fmt::format("{}\n", fmt::join(values, " "));
}

Stages stagesFrom(const std::string& text) {
    Stages stages;
    std::istringstream in(text);
    for (const auto stage : kStages)
        in >> stages.*stage;
    if (!in) throw DeviceError("the start-up probe printed '" + text + "'");
    return stages;
}

} // namespace stromboli::bench
