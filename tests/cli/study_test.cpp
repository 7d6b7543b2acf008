#include "host/cli/options.hpp"
#include "host/study/study.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

std::vector<std::string> tinyStudy(const ScratchFolder& folder) {
    return {"study",
            "cornell_spheres",
            "-o",
            folder.file("s"),
            "-r",
            "16",
            "12",
            "-s",
            "2,4",
            "--seeds",
            "2",
            "-c",
            "default",
            "-c",
            "few=-a 2 {0.5}",
            "-c",
            "denoised"};
}

TEST(StudyCommand, MeasuresAndGoesOn) {
    const ScratchFolder folder;
    const ProgramRun run = stromboli(tinyStudy(folder));
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("cornell_spheres, 16 x 12; reference of 64 samples"));
    const auto json = nlohmann::json::parse(std::ifstream(folder.file("s/study.json")));
    EXPECT_EQ(json["scenes"][0]["runs"].size(), 6u);
    EXPECT_GT(json["scenes"][0]["runs"][0]["points"][1]["wallSeconds"].get<double>(), 0);
    for (const auto& one : json["scenes"][0]["runs"]) {
        if (one["configuration"] != "denoised") continue;
        EXPECT_EQ(one["points"].size(), 2u);
        for (const auto& point : one["points"]) {
            EXPECT_GT(point["cpuSeconds"].get<double>(), 0);
            EXPECT_GT(point["relMse"].get<double>(), 0);
        }
    }
    for (const char* name : {"s/study.csv", "s/report.html", "s/references/cornell_spheres.exr",
                             "s/pictures/cornell_spheres-few-0-samples.png"})
        EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;

    const ProgramRun again = stromboli(tinyStudy(folder));
    EXPECT_EQ(again.exitCode, 0);
    EXPECT_THAT(again.err, HasSubstr("6 runs are there already"));
    const auto kept = nlohmann::json::parse(std::ifstream(folder.file("s/study.json")));
    EXPECT_EQ(kept["scenes"][0]["runs"], json["scenes"][0]["runs"]);
}

TEST(StudyCommand, ListsItsConfigurations) {
    const ProgramRun run = stromboli({"study", "--list"});
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_THAT(run.out, HasSubstr("hemisphere     --direct hemisphere"));
}

TEST(StudyCommand, EveryKnownConfigurationIsMadeOfOptionsOfRender) {
    for (const study::Configuration& c : study::knownConfigurations())
        for (const double step : c.steps.empty() ? std::vector<double>{0} : c.steps) {
            std::vector<std::string> line = {"render", "scene.dae", "-o", "a.exr"};
            for (const std::string& word : study::optionsAt(c, step))
                line.push_back(word);
            EXPECT_NO_THROW(parseOptions(line)) << c.name;
        }
}

TEST(StudyCommand, BadInputIsOneLine) {
    const ScratchFolder folder;
    const std::vector<std::pair<int, std::vector<std::string>>> bad = {
        {1, {}},
        {2, {"no-such-scene"}},
        {1, {"cornell_spheres", "-c", "nothing"}},
        {1, {"cornell_spheres", "-c", "a=--no-such-option"}},
        {1, {"cornell_spheres", "-c", "a=--crop 0 0 2 2"}},
        {1, {"cornell_spheres", "-s", "4"}},
        {1, {"cornell_spheres", "-s", "8,4"}},
        {1, {"cornell_spheres", "--baseline", "bsdf"}},
        {1, {"cornell_spheres", "--target-samples", "1000"}}};
    for (const auto& [code, arguments] : bad) {
        std::vector<std::string> line = {"study", "-o", folder.file("s")};
        line.insert(line.end(), arguments.begin(), arguments.end());
        const ProgramRun run = stromboli(line);
        EXPECT_EQ(run.exitCode, code) << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
    EXPECT_TRUE(folder.entries().empty()); // nothing is begun before all is understood
}

} // namespace
} // namespace stromboli::test
