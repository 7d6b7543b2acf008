#include "host/study/journal.hpp"

#include "host/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace stromboli::study {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0)
        throw OutputError(fmt::format("{}: no file can be made in the folder: {}", folder.string(),
                                      std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    const int reason = errno;
    ::close(descriptor_);
    if (reason == EWOULDBLOCK)
        throw OutputError(
            fmt::format("{}: another study is writing to this folder; wait for it, or "
                        "name another folder with -o",
                        folder.string()));
    throw OutputError(fmt::format("{}: {}", folder.string(), std::strerror(reason)));
}

FolderLock::~FolderLock() {
    ::close(descriptor_);
}

namespace {

constexpr const char* kFormat = "stromboli study 1";

Json toJson(const Estimate& e) {
    Json json = {{"value", e.value}, {"low", nullptr}, {"high", nullptr}};
    if (e.interval) json["low"] = e.interval->first, json["high"] = e.interval->second;
    return json;
}

template <class T>
Json orNull(const std::optional<T>& value) {
    if constexpr (std::is_same_v<T, Estimate>)
        return value ? toJson(*value) : Json(nullptr);
    else
        return value ? Json(*value) : Json(nullptr);
}

Json toJson(const Point& p) {
    return {{"effort", p.effort},
            {"samples", p.samples},
            {"wallSeconds", p.wallSeconds},
            {"cpuSeconds", p.cpuSeconds},
            {"relMse", p.relMse},
            {"mse", p.mse},
            {"bias", p.bias},
            {"rays", p.rays},
            {"rejected", p.rejected},
            {"noiseKnown", p.noise.known()},
            {"noise", p.noise.estimate},
            {"noiseLeast", p.noise.least},
            {"noiseMost", p.noise.most}};
}

Json toJson(const Run& r) {
    Json points = Json::array();
    for (const Point& p : r.points)
        points.push_back(toJson(p));
    return {{"configuration", r.configuration},
            {"seed", r.seed},
            {"cutShort", r.cutShort},
            {"points", points}};
}

Json toJson(const Reference& r) {
    return {{"file", r.file},       {"options", r.options}, {"samples", r.samples},
            {"seconds", r.seconds}, {"relMse", r.relMse},   {"meanError", r.meanError}};
}

Json toJson(const ClockSummary& s) {
    return {{"timeToTarget", orNull(s.timeToTarget)},
            {"extrapolated", s.extrapolated},
            {"efficiency", orNull(s.efficiency)},
            {"errorAtEqualTime", toJson(s.errorAtEqualTime)},
            {"errorExtrapolated", s.errorExtrapolated}};
}

Json toJson(const SummaryPoint& p) {
    return {{"effort", p.effort},           {"samples", p.samples},
            {"wallSeconds", p.wallSeconds}, {"cpuSeconds", p.cpuSeconds},
            {"relMse", toJson(p.relMse)},   {"limitedByReference", p.limitedByReference}};
}

Json toJson(const ConfigurationSummary& s) {
    Json points = Json::array();
    for (const SummaryPoint& p : s.points)
        points.push_back(toJson(p));
    return {{"name", s.name},         {"options", s.options},     {"what", s.what},
            {"points", points},       {"slope", orNull(s.slope)}, {"bias", toJson(s.bias)},
            {"wall", toJson(s.wall)}, {"cpu", toJson(s.cpu)}};
}

Json ratios(const SceneSummary& s, Clock clock) {
    Json list = Json::array();
    for (const ConfigurationSummary& a : s.configurations)
        for (const ConfigurationSummary& b : s.configurations)
            if (a.name != b.name)
                list.push_back({{"of", a.name},
                                {"to", b.name},
                                {"time", orNull(timeRatio(a, b, clock))},
                                {"error", orNull(errorRatio(a, b, clock))}});
    return list;
}

Json toJson(const SceneSummary& s) {
    Json configurations = Json::array();
    for (const ConfigurationSummary& c : s.configurations)
        configurations.push_back(toJson(c));
    return {{"baseline", s.baseline},
            {"targetError", s.targetError},
            {"configurations", configurations},
            {"ratios", {{"wall", ratios(s, Clock::Wall)}, {"cpu", ratios(s, Clock::Cpu)}}}};
}

Json toJson(const StudySettings& s) {
    Json configurations = Json::array();
    for (const Configuration& c : s.configurations)
        configurations.push_back({{"name", c.name},
                                  {"options", c.options},
                                  {"effort", c.effort},
                                  {"steps", c.steps},
                                  {"what", c.what}});
    return {{"commonOptions", s.commonOptions},
            {"sampleCounts", s.sampleCounts},
            {"seeds", s.seeds},
            {"referenceSamples", s.referenceSamples},
            {"mostSecondsPerRun", s.mostSecondsPerRun},
            {"targetSamples", s.targetSamples},
            {"configurations", configurations}};
}

/// The noise as the render stated it; if it did not, the reason is not kept.
PictureNoise noiseFrom(const Json& j) {
    if (!j.value("noiseKnown", false)) return {};
    const auto number = [&](const char* name) { return j.at(name).get<double>(); };
    return {PictureNoise::Unknown::No, number("noise"), number("noiseLeast"), number("noiseMost")};
}

Point pointFrom(const Json& j) {
    const auto number = [&](const char* name) { return j.at(name).get<double>(); };
    const auto count = [&](const char* name) { return j.at(name).get<uint64_t>(); };
    return {number("effort"),  number("samples"), number("wallSeconds"), number("cpuSeconds"),
            number("relMse"),  number("mse"),     number("bias"),        count("rays"),
            count("rejected"), noiseFrom(j)};
}

Run runFrom(const Json& j) {
    Run run{j.at("configuration").get<std::string>(),
            j.at("seed").get<uint32_t>(),
            {},
            j.at("cutShort").get<bool>()};
    for (const Json& p : j.at("points"))
        run.points.push_back(pointFrom(p));
    return run;
}

std::vector<double> effortsOf(const Configuration& c, const StudySettings& s) {
    if (!c.effort.empty()) return c.steps;
    return {s.sampleCounts.begin(), s.sampleCounts.end()};
}

/// Whether a run is what this study would measure.
bool fits(const Run& run, const Configuration& c, const StudySettings& s) {
    const std::vector<double> efforts = effortsOf(c, s);
    if (run.seed < 1 || run.seed > s.seeds || run.points.size() > efforts.size() ||
        (run.points.size() < efforts.size() && !run.cutShort))
        return false;
    return std::equal(run.points.begin(), run.points.end(), efforts.begin(),
                      [](const Point& p, double effort) { return p.effort == effort; });
}

bool sameOptions(const Json& configurations, const Configuration& c) {
    return std::ranges::any_of(configurations, [&](const Json& j) {
        return j.at("name") == c.name && j.at("options") == c.options && j.at("effort") == c.effort;
    });
}

size_t takeRuns(const Json& json, const Json& configurations, const StudySettings& settings,
                SceneStudy& scene) {
    size_t taken = 0;
    for (const Json& j : json.at("runs")) {
        const Run run = runFrom(j);
        for (const Configuration& c : settings.configurations)
            if (c.name == run.configuration && sameOptions(configurations, c) &&
                fits(run, c, settings)) {
                scene.runs.push_back(run);
                ++taken;
            }
    }
    return taken;
}

} // namespace

Json toJson(const Study& study) {
    Json scenes = Json::array();
    for (const SceneStudy& s : study.scenes) {
        Json runs = Json::array();
        for (const Run& run : s.runs)
            runs.push_back(toJson(run));
        scenes.push_back({{"name", s.name},
                          {"content", s.content},
                          {"width", s.width},
                          {"height", s.height},
                          {"reference", toJson(s.reference)},
                          {"summary", toJson(summarise(s, study.settings))},
                          {"runs", runs}});
    }
    return {{"format", kFormat},
            {"key", study.key},
            {"circumstances", study.circumstances},
            {"deviceIsCpu", study.deviceIsCpu},
            {"settings", toJson(study.settings)},
            {"scenes", scenes}};
}

size_t takeOver(const std::filesystem::path& file, Study& study) {
    if (!std::filesystem::exists(file)) return 0;
    std::ifstream in(file);
    const Json json = Json::parse(in, nullptr, false);
    if (!json.is_object() || json.value("format", std::string()) != kFormat)
        throw OutputError(file.string() + ": not a study of this program; choose another folder");
    if (json.value("key", std::string()) != study.key) return 0;
    size_t taken = 0;
    try {
        for (const Json& j : json.at("scenes"))
            for (SceneStudy& scene : study.scenes)
                if (j.at("name") == scene.name && j.at("content") == scene.content)
                    taken += takeRuns(j, json.at("settings").at("configurations"), study.settings,
                                      scene);
    } catch (const Json::exception& error) {
        throw OutputError(fmt::format("{}: {}", file.string(), error.what()));
    }
    return taken;
}

static std::string noiseColumns(const PictureNoise& noise) {
    if (!noise.known()) return ",,";
    return fmt::format("{},{},{}", noise.estimate, noise.least, noise.most);
}

std::string toCsv(const Study& study) {
    std::string text = "scene,configuration,seed,effort,samples,wall_seconds,cpu_seconds,relmse,"
                       "reference_relmse,mse,bias,rays,rejected,noise,noise_least,noise_most\n";
    for (const SceneStudy& s : study.scenes)
        for (const Run& run : s.runs)
            for (const Point& p : run.points)
                text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", s.name,
                                    run.configuration, run.seed, p.effort, p.samples, p.wallSeconds,
                                    p.cpuSeconds, p.relMse, s.reference.relMse, p.mse, p.bias,
                                    p.rays, p.rejected, noiseColumns(p.noise));
    return text;
}

} // namespace stromboli::study
