// What becomes of the measurements: JSON with every key, a table with every figure.
#include "host/bench/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace stromboli::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

Series series(const std::string& name, double seconds) {
    Series s;
    s.name = name;
    s.wallSeconds = {seconds, 2 * seconds, 3 * seconds};
    s.cpuSeconds = {2 * seconds, 4 * seconds, 6 * seconds};
    return s;
}

std::vector<Series> contestants(double unit) {
    return {series("device", unit), series("Embree fast", 2 * unit),
            series("Embree robust", 3 * unit)};
}

BenchReport fullReport() {
    BenchReport report;
    report.circumstances.device = "llvmpipe";
    report.circumstances.deviceIsCpu = true;
    report.circumstances.commandLine = "stromboli bench";
    SceneReport& scene = report.scenes.emplace_back();
    scene.name = "cornell_boxes";
    scene.triangles = 36;
    scene.bvh = BvhReport{contestants(1e-3), series("binary tree", 1e-3), 9.5, 64, 96};
    scene.rays.push_back({"bounce", 1000, 0.75, 4.5, 2.5, contestants(1e-7), {3, 0}});
    PathReport paths;
    paths.contestants = contestants(1e-6);
    paths.driverBusy = 0.97;
    paths.lanesBusy = 0.6;
    scene.paths = paths;
    scene.variants =
        VariantReport{{series("specialised", 1e-6), series("everything on", 1.5e-6)}, {true}};
    scene.textures =
        TextureReport{{series("textures", 1e-7), series("their means", 0.9e-7)}, {2.5, 2.25}};
    report.growth.push_back({"generate:cornell_mesh:1000", 1006, 0.001, 0.002, scene.rays.front()});
    report.startup = StartupReport{{series("cold", 0.5), series("warm", 0.1)}, {}, {}};
    report.transfer = TransferReport{1 << 26, {series("upload", 1e-9), series("readback", 1e-9)}};
    return report;
}

/// Every key, as paths; arrays by their first entry.
nlohmann::ordered_json parsed(const BenchReport& report) {
    return nlohmann::ordered_json::parse(toJson(report).dump());
}

void collectKeys(const nlohmann::ordered_json& json, const std::string& path,
                 std::vector<std::string>& keys) {
    if (json.is_array() && !json.empty()) collectKeys(json.front(), path + "[]", keys);
    if (!json.is_object()) return;
    for (const auto& [key, value] : json.items()) {
        keys.push_back(path + "/" + key);
        collectKeys(value, path + "/" + key, keys);
    }
}

TEST(BenchJson, HasEveryKey) {
    std::vector<std::string> keys;
    collectKeys(parsed(fullReport()), "", keys);
    for (const char* key : {"/circumstances/date",
                            "/circumstances/commandLine",
                            "/circumstances/version",
                            "/circumstances/cpu",
                            "/circumstances/cores",
                            "/circumstances/threads",
                            "/circumstances/system",
                            "/circumstances/device",
                            "/circumstances/deviceIsCpu",
                            "/circumstances/driver",
                            "/circumstances/compiler",
                            "/circumstances/embree/version",
                            "/circumstances/embree/flags",
                            "/circumstances/embree/missing",
                            "/scenes[]/name",
                            "/scenes[]/triangles",
                            "/scenes[]/spheres",
                            "/scenes[]/width",
                            "/scenes[]/height",
                            "/scenes[]/samplesPerPixel",
                            "/scenes[]/maxBounces",
                            "/scenes[]/embreeQuality",
                            "/scenes[]/bvh/builds",
                            "/scenes[]/bvh/binaryTree",
                            "/scenes[]/bvh/expectedVisits",
                            "/scenes[]/bvh/bytesPerPrimitive",
                            "/scenes[]/bvh/embreeBytesPerPrimitive",
                            "/scenes[]/rays[]/kind",
                            "/scenes[]/rays[]/rays",
                            "/scenes[]/rays[]/hitShare",
                            "/scenes[]/rays[]/nodes",
                            "/scenes[]/rays[]/leaves",
                            "/scenes[]/rays[]/disagreements",
                            "/scenes[]/rays[]/contestants[]/name",
                            "/scenes[]/rays[]/contestants[]/wallSeconds/median",
                            "/scenes[]/rays[]/contestants[]/wallSeconds/least",
                            "/scenes[]/rays[]/contestants[]/wallSeconds/most",
                            "/scenes[]/rays[]/contestants[]/wallSeconds/lowerQuartile",
                            "/scenes[]/rays[]/contestants[]/wallSeconds/upperQuartile",
                            "/scenes[]/rays[]/contestants[]/wallSeconds/all",
                            "/scenes[]/rays[]/contestants[]/cpuSeconds/median",
                            "/scenes[]/rays[]/contestants[]/itemsPerSecond/median",
                            "/scenes[]/rays[]/contestants[]/threadsAtWork",
                            "/scenes[]/paths/raysPerPath",
                            "/scenes[]/paths/contestants",
                            "/scenes[]/paths/driverBusy",
                            "/scenes[]/paths/lanesBusy",
                            "/scenes[]/variants/contestants",
                            "/scenes[]/variants/samePicture",
                            "/scenes[]/textures/contestants",
                            "/scenes[]/textures/raysPerPath",
                            "/growth[]/scene",
                            "/growth[]/triangles",
                            "/growth[]/buildSeconds",
                            "/growth[]/embreeBuildSeconds",
                            "/growth[]/bounce/kind",
                            "/startup/wholeProcess",
                            "/startup/cold/device",
                            "/startup/cold/load",
                            "/startup/cold/build",
                            "/startup/cold/pipeline",
                            "/startup/cold/firstDispatch",
                            "/startup/warm/secondDispatch",
                            "/transfer/bytes",
                            "/transfer/directions"})
        EXPECT_THAT(keys, testing::Contains(key));
}

TEST(BenchJson, ComparesWithOurs) {
    const auto rays = parsed(fullReport())["scenes"][0]["rays"][0]["contestants"];
    EXPECT_FALSE(rays[0].contains("oursIsFaster"));
    EXPECT_DOUBLE_EQ(rays[2]["oursIsFaster"]["wall"]["median"].get<double>(), 3);
    EXPECT_DOUBLE_EQ(rays[2]["oursIsFaster"]["cpu"]["least"].get<double>(), 3);
    EXPECT_DOUBLE_EQ(rays[0]["itemsPerSecond"]["median"].get<double>(), 0.5e7);
    EXPECT_EQ(rays[0]["wallSeconds"]["all"].size(), 3u);
}

TEST(BenchJson, WhatWasNotMeasuredIsNull) {
    BenchReport report;
    report.scenes.emplace_back();
    const auto json = parsed(report);
    EXPECT_TRUE(json["startup"].is_null());
    EXPECT_TRUE(json["transfer"].is_null());
    EXPECT_TRUE(json["scenes"][0]["bvh"].is_null());
    EXPECT_TRUE(json["scenes"][0]["rays"].empty());
}

TEST(BenchTable, SaysItAll) {
    const std::string table = toTable(fullReport());
    EXPECT_THAT(table, HasSubstr("cornell_boxes: 36 triangles"));
    EXPECT_THAT(table, HasSubstr("Embree fast disagrees on 3; Embree robust disagrees on 0"));
    EXPECT_THAT(table, HasSubstr("x 3.00 [3.00 3.00], by CPU time x 3.00"));
    EXPECT_THAT(table, HasSubstr("driver threads busy 97.0 %"));
    EXPECT_THAT(table, HasSubstr("everything on: the same picture"));
    EXPECT_THAT(table, HasSubstr("       1006"));
    EXPECT_THAT(table, HasSubstr("transfer of 64 MiB"));
}

TEST(BenchTable, SaysWhyThereIsNoEmbree) {
    BenchReport report = fullReport();
    report.circumstances.embreeMissing = "the program was built without it";
    const std::string table = toTable(report);
    EXPECT_THAT(table, HasSubstr("Embree  none: the program was built without it"));
}

TEST(BenchTable, SaysHowTimesGrow) {
    BenchReport report = fullReport();
    EXPECT_THAT(toTable(report), Not(HasSubstr("grows by"))) << "one size";
    report.growth.push_back({"generate:cornell_mesh:4000",
                             4006,
                             0.001,
                             0.002,
                             {"bounce", 1000, 0.75, 4.5, 2.5, contestants(5e-7), {}}});
    // Medians: 200, 400 and 600 ns with the first size, 1000, 2000 and 3000 ns with the last.
    EXPECT_THAT(toTable(report),
                testing::ContainsRegex(
                    "grows by: +800\\.0 \\(x 5\\.00\\) +1600\\.0 \\(x 5\\.00\\) +2400\\.0"));
}

/// A GPU's work is no CPU time: no comparison by it.
TEST(BenchTable, ComparesGpusByWallTimeAlone) {
    BenchReport report = fullReport();
    report.circumstances.deviceIsCpu = false;
    report.scenes[0].bvh.reset(); // built on the CPU whatever the device
    report.startup.reset();
    EXPECT_THAT(toTable(report), Not(HasSubstr("by CPU time")));
}

} // namespace
} // namespace stromboli::bench
