#include "host/bench/report_json.hpp"

#include <nlohmann/json.hpp>

namespace stromboli::bench {
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

} // namespace stromboli::bench
