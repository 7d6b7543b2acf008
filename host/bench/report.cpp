#include "host/bench/report.hpp"

#include "host/version/version.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sys/utsname.h>
#include <thread>

namespace stromboli::bench {

// --- As JSON -------------------------------------------------------------------------------------

namespace {

Json toJson(const Spread& s) {
    return {{"median", s.median},
            {"least", s.least},
            {"most", s.most},
            {"lowerQuartile", s.lowerQuartile},
            {"upperQuartile", s.upperQuartile}};
}

Json measured(const std::vector<double>& values) {
    Json json = toJson(spreadOf(values));
    json["all"] = values;
    return json;
}

Json toJson(const Series& s, const Series& ours) {
    Json json = {{"name", s.name},
                 {"wallSeconds", measured(s.wallSeconds)},
                 {"cpuSeconds", measured(s.cpuSeconds)},
                 {"itemsPerSecond", toJson(s.wallRate())},
                 {"threadsAtWork", s.parallelism()}};
    if (!s.deviceSeconds.empty()) json["deviceSeconds"] = measured(s.deviceSeconds);
    if (&s != &ours)
        json["oursIsFaster"] = {{"wall", toJson(speedup(ours.wallSeconds, s.wallSeconds))},
                                {"cpu", toJson(speedup(ours.cpuSeconds, s.cpuSeconds))}};
    return json;
}

Json toJson(const std::vector<Series>& all) {
    Json json = Json::array();
    for (const Series& s : all)
        json.push_back(toJson(s, all.front()));
    return json;
}

Json toJson(const Circumstances& c) {
    return {
        {"date", c.date},
        {"commandLine", c.commandLine},
        {"version", c.version},
        {"cpu", c.cpu},
        {"cores", c.cores},
        {"threads", c.threads},
        {"system", c.system},
        {"device", c.device},
        {"deviceIsCpu", c.deviceIsCpu},
        {"driver", c.driver},
        {"compiler", c.compiler},
        {"embree",
         {{"version", c.embreeVersion}, {"flags", c.embreeFlags}, {"missing", c.embreeMissing}}}};
}

Json toJson(const BvhReport& b) {
    return {{"builds", toJson(b.builds)},
            {"binaryTree", toJson(b.binaryTree, b.binaryTree)},
            {"expectedVisits", b.expectedVisits},
            {"bytesPerPrimitive", b.bytesPerPrimitive},
            {"embreeBytesPerPrimitive", b.embreeBytesPerPrimitive}};
}

Json toJson(const RayReport& r) {
    return {{"kind", r.kind},
            {"rays", r.rays},
            {"hitShare", r.hitShare},
            {"nodes", r.nodes},
            {"leaves", r.leaves},
            {"contestants", toJson(r.contestants)},
            {"disagreements", r.disagreements}};
}

Json toJson(const PathReport& p) {
    return {{"raysPerPath", p.raysPerPath},
            {"contestants", toJson(p.contestants)},
            {"driverBusy", p.driverBusy},
            {"lanesBusy", p.lanesBusy}};
}

Json toJson(const VariantReport& v) {
    return {{"contestants", toJson(v.contestants)}, {"samePicture", v.samePicture}};
}

Json toJson(const TextureReport& t) {
    return {{"contestants", toJson(t.contestants)}, {"raysPerPath", t.raysPerPath}};
}

Json toJson(const SceneReport& s);
Json toJson(const GrowthPoint& g);
Json toJson(const StartupReport& s);
Json toJson(const TransferReport& t);

template <class T>
Json orNull(const std::optional<T>& value) {
    return value ? toJson(*value) : Json(nullptr);
}

template <class T>
Json listOf(const std::vector<T>& values) {
    Json json = Json::array();
    for (const T& value : values)
        json.push_back(toJson(value));
    return json;
}

Json toJson(const SceneReport& s) {
    return {{"name", s.name},
            {"triangles", s.triangles},
            {"spheres", s.spheres},
            {"width", s.width},
            {"height", s.height},
            {"samplesPerPixel", s.samplesPerPixel},
            {"maxBounces", s.maxBounces},
            {"embreeQuality", s.embreeQuality},
            {"bvh", orNull(s.bvh)},
            {"rays", listOf(s.rays)},
            {"paths", orNull(s.paths)},
            {"variants", orNull(s.variants)},
            {"textures", orNull(s.textures)}};
}

Json toJson(const GrowthPoint& g) {
    return {{"scene", g.scene},
            {"triangles", g.triangles},
            {"buildSeconds", g.buildSeconds},
            {"embreeBuildSeconds", g.embreeBuildSeconds},
            {"bounce", toJson(g.bounce)}};
}

Json toJson(const StartupReport::Stages& s) {
    return {{"device", s.device},
            {"load", s.load},
            {"build", s.build},
            {"pipeline", s.pipeline},
            {"firstDispatch", s.firstDispatch},
            {"secondDispatch", s.secondDispatch}};
}

Json toJson(const StartupReport& s) {
    return {{"wholeProcess", toJson(s.wholeProcess)},
            {"cold", toJson(s.cold)},
            {"warm", toJson(s.warm)}};
}

Json toJson(const TransferReport& t) {
    return {{"bytes", t.bytes}, {"directions", toJson(t.directions)}};
}

} // namespace

Json toJson(const BenchReport& report) {
    return {{"circumstances", toJson(report.circumstances)},
            {"scenes", listOf(report.scenes)},
            {"growth", listOf(report.growth)},
            {"startup", orNull(report.startup)},
            {"transfer", orNull(report.transfer)}};
}

// --- Circumstances -------------------------------------------------------------------------------

namespace {

/// "model name" of /proc/cpuinfo, as Linux states it.
std::string cpuName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) {
            const size_t colon = line.find(": ");
            if (colon != std::string::npos) return line.substr(colon + 2);
        }
    return "unknown CPU";
}

std::string systemName() {
    utsname name{};
    uname(&name);
    return fmt::format("{} {} {}", name.sysname, name.release, name.machine);
}

uint32_t cores() {
    return std::max(1u, std::thread::hardware_concurrency());
}

} // namespace

uint32_t deviceThreads(const vulkan::DeviceDescription& device) {
    if (!device.isCpu()) return 0;
    const char* wanted = std::getenv("LP_NUM_THREADS");
    const int number = wanted ? std::atoi(wanted) : 0;
    return number > 0 ? uint32_t(number) : cores();
}

Circumstances circumstancesOf(const vulkan::DeviceDescription& device, const OpenedEmbree& embree,
                              uint32_t threads, const std::string& commandLine) {
    Circumstances c;
    c.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    c.commandLine = commandLine;
    c.version = version();
    c.cpu = cpuName();
    c.system = systemName();
    c.cores = cores();
    c.threads = threads;
    c.device = device.name();
    c.driver = device.driver;
    c.deviceIsCpu = device.isCpu();
    c.compiler = STROMBOLI_COMPILER;
    c.embreeMissing = embree.missing;
    if (embree.embree) {
        c.embreeVersion = embree.embree->version();
        c.embreeFlags = embree.embree->compiledWith();
    }
    return c;
}

} // namespace stromboli::bench
