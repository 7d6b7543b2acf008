#include "host/bench/startup_bench.hpp"

#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "host/engine/load_scene.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "host/vulkan/buffer.hpp"
#include "host/vulkan/device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>

namespace stromboli::bench {
namespace {

std::vector<std::string> environmentWith(const Environment& changes) {
    std::vector<std::string> all;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry;
        const std::string name = text.substr(0, text.find('='));
        const bool changed = std::any_of(changes.begin(), changes.end(),
                                         [&](const auto& c) { return c.first == name; });
        if (!changed) all.push_back(text);
    }
    for (const auto& [name, value] : changes)
        all.push_back(name + "=" + value);
    return all;
}

/// The argument list that exec takes: pointers to the strings, the last one null. The strings must
/// outlive it.
std::vector<char*> pointers(std::vector<std::string>& strings) {
    std::vector<char*> result;
    for (std::string& s : strings)
        result.push_back(s.data());
    result.push_back(nullptr);
    return result;
}

/// Where the three standard streams of a child go.
class Streams {
  public:
    Streams(const std::string& out, const std::string& err) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, out.c_str(), flags, 0600);
        posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, err.c_str(), flags, 0600);
    }
    ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

  private:
    posix_spawn_file_actions_t actions_;
};

std::string textOf(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

std::string lastLine(const std::string& text) {
    const size_t end = text.find_last_not_of('\n');
    if (end == std::string::npos) return "it said nothing";
    const size_t before = text.rfind('\n', end);
    const size_t begin = before == std::string::npos ? 0 : before + 1;
    return text.substr(begin, end + 1 - begin);
}

} // namespace

ScratchFolder::ScratchFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "stromboli-bench-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
        throw OutputError(fmt::format("cannot make {}: {}", pattern, std::strerror(errno)));
    path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string runProgram(const std::vector<std::string>& command, const Environment& changes) {
    const ScratchFolder folder;
    const std::filesystem::path out = folder.path() / "out", err = folder.path() / "err";
    const Streams streams(out.string(), err.string());
    std::vector<std::string> arguments = command, environment = environmentWith(changes);
    pid_t child = 0;
    const int error = posix_spawn(&child, command[0].c_str(), streams.get(), nullptr,
                                  pointers(arguments).data(), pointers(environment).data());
    if (error != 0)
        throw DeviceError(fmt::format("cannot start {}: {}", command[0], std::strerror(error)));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw DeviceError(
            fmt::format("'{}' failed: {}", fmt::join(command, " "), lastLine(textOf(err))));
    return textOf(out);
}

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
    const std::shared_ptr<const Scene> scene = loadScene({sceneFile, {}, {}}).scene;
    lap(&Stages::load);
    const GpuScene gpu = buildScene(*scene, Estimator{}).gpu;
    lap(&Stages::build);
    RenderSettings settings;
    settings.area.width = settings.area.height = kSide;
    settings.budget.mostSamplesPerPixel = 1;
    const Camera camera = makeCamera(*scene, CameraChoice::Automatic, kSide, kSide);
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

namespace {

constexpr uint64_t kBytes = uint64_t(64) << 20; ///< the size of a large scene's buffers

} // namespace

TransferReport benchTransfer(const vulkan::Device& device, const AlternatePlan& plan) {
    vulkan::Queue queue(device);
    vulkan::Buffer buffer(device, "buffer of the transfer benchmark", kBytes,
                          vulkan::BufferUse::Storage);
    std::vector<std::byte> data(kBytes, std::byte{1});
    TransferReport report;
    report.bytes = kBytes;
    report.directions = alternate({{"upload",
                                    [&] {
                                        buffer.upload(queue, data);
                                        return Work{double(kBytes), 0};
                                    }},
                                   {"readback",
                                    [&] {
                                        buffer.download(queue, data);
                                        return Work{double(kBytes), 0};
                                    }}},
                                  plan);
    return report;
}

} // namespace stromboli::bench
