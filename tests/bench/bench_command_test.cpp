// `stromboli bench` as a user meets it.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

constexpr int kUsage = 1, kScene = 2, kOutput = 4;

ProgramRun bench(std::vector<std::string> arguments) {
    // Short, should a wrong command line be taken for a right one.
    arguments.insert(arguments.begin(), {"bench", "--quick", "--repeats", "1"});
    // Kernels take longer to compile than these pictures; lavapipe leaves out optimisation.
    return stromboli(arguments, "GALLIVM_PERF=nopt");
}

void expectRefused(const ProgramRun& run, int exitCode, const std::string& message) {
    EXPECT_EQ(run.exitCode, exitCode) << run.err;
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(run.out, "");
}

TEST(BenchCommand, BadOptionsAreRefused) {
    for (const char* sizes : {"5x", "k", "10", "1k,", "1k,,2k", "200M", "-1k", "1.0005k"})
        expectRefused(bench({"--sizes", sizes}), kUsage, "--sizes");
    expectRefused(bench({"--only", "speed"}), kUsage, "--only");
    expectRefused(stromboli({"bench", "--repeats", "0"}), kUsage, "--repeats");
    expectRefused(bench({"--rays", "0"}), kUsage, "--rays");
    expectRefused(bench({"-s", "0"}), kUsage, "-s");
    expectRefused(bench({"-r", "0", "8"}), kUsage, "-r");
}

TEST(BenchCommand, AMissingSceneIsFoundBeforeTheWork) {
    expectRefused(bench({"cornell_boxes", "no_such_scene"}), kScene, "no_such_scene");
    expectRefused(bench({"--only", "transfer", "generate:no_such_scene:1000"}), kScene,
                  "no_such_scene");
}

TEST(BenchCommand, AnUnwritableReportIsFoundBeforeTheWork) {
    const ScratchFolder folder;
    expectRefused(bench({"--json", folder.file("missing/bench.json")}), kOutput, "bench.json");
}

/// All parts, tiny. Nothing on standard error in a pipe.
TEST(BenchCommand, ReportsOnTheTerminalAndAsJson) {
    const ScratchFolder folder;
    const ProgramRun run = bench({"cornell_boxes", "-r", "16", "16", "-s", "1", "--sizes", "1k",
                                  "--json", folder.file("bench.json")});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(run.err, "");
    for (const char* text : {"cornell_boxes: 36 triangles", "BVH build", "camera rays: 256",
                             "bounce rays", "paths of", "kernel variants", "start-up", "transfer",
                             "time for a bounce ray", "stromboli bench --quick"})
        EXPECT_THAT(run.out, HasSubstr(text));
    const nlohmann::json json = nlohmann::json::parse(std::ifstream(folder.file("bench.json")));
    EXPECT_EQ(json["scenes"][0]["rays"].size(), 3u);
    EXPECT_EQ(json["growth"].size(), 1u);
    EXPECT_GT(json["startup"]["warm"]["pipeline"].get<double>(), 0);
    EXPECT_EQ(folder.entries(), (std::vector<std::string>{"bench.json"}));
}

/// By ray, of the scenes that have some.
TEST(BenchCommand, SaysWhatTexturesCost) {
    const ProgramRun run = bench(
        {"cornell_boxes", "texture_chart", "--only", "textures", "-r", "16", "16", "-s", "1"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const size_t chart = run.out.find("texture_chart: ");
    ASSERT_NE(chart, std::string::npos);
    EXPECT_EQ(run.out.find("rays of paths with textures"),
              run.out.rfind("rays of paths with textures"));
    EXPECT_GT(run.out.find("rays of paths with textures"), chart);
    EXPECT_THAT(run.out, HasSubstr("their means"));
}

TEST(BenchCommand, OnlyWhatWasAskedFor) {
    const ProgramRun run = bench({"cornell_boxes", "--only", "bvh"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("BVH build"));
    for (const char* text : {"rays:", "paths of", "start-up", "transfer"})
        EXPECT_THAT(run.out, testing::Not(HasSubstr(text)));
}

} // namespace
} // namespace stromboli::test
