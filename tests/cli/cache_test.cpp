// What earlier runs left in the user's cache changes how soon a picture is there, and nothing else.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;

class CachedRuns : public testing::Test {
  protected:
    /// Renders with caches of its own, the driver's too (Mesa's variable; others have no effect).
    std::string picture(const std::string& environment, const std::string& name = "out.png") {
        const ProgramRun run =
            stromboli({"render", libraryScene("cornell_boxes.dae"), "-o", folder_.file(name), "-s",
                       "1", "-r", "16", "16", "-q"},
                      "MESA_SHADER_CACHE_DIR=" + folder_.file("driver") + " " + environment);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_EQ(run.err, "");
        std::ifstream file(folder_.file(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::string here() const { return "STROMBOLI_CACHE_DIR=" + folder_.file("cache"); }

    ScratchFolder folder_;
};

TEST_F(CachedRuns, ColdAndWarmGiveTheSameBytes) {
    const std::string cold = picture(here());
    EXPECT_FALSE(cold.empty());
    EXPECT_EQ(picture(here()), cold);
    int kept = 0; // the kernel's module, and what the driver gives out
    for (const auto& entry : fs::recursive_directory_iterator(folder_.file("cache")))
        if (entry.is_regular_file()) {
            fs::resize_file(entry, fs::file_size(entry) / 2);
            ++kept;
        }
    EXPECT_GE(kept, 1);
    EXPECT_EQ(picture(here()), cold);
}

TEST_F(CachedRuns, WhereNothingCanBeKeptNothingIsSaid) {
    const std::string usual = picture(here());
    folder_.write("file", "in the way");
    for (const std::string& environment :
         {std::string("STROMBOLI_CACHE_DIR="), std::string("STROMBOLI_CACHE_DIR=/proc/none"),
          "STROMBOLI_CACHE_DIR=" + folder_.file("file"),
          std::string("-u STROMBOLI_CACHE_DIR -u HOME -u XDG_CACHE_HOME")})
        EXPECT_EQ(picture("env " + environment), usual) << environment;
}

TEST_F(CachedRuns, RunsAtTheSameTimeGiveTheSameBytes) {
    std::vector<std::future<std::string>> runs;
    for (int i = 0; i < 3; ++i)
        runs.push_back(std::async(
            std::launch::async, [this, i] { return picture(here(), std::to_string(i) + ".png"); }));
    const std::string first = runs[0].get();
    EXPECT_FALSE(first.empty());
    EXPECT_EQ(runs[1].get(), first);
    EXPECT_EQ(runs[2].get(), first);
}

TEST(GeneratedScenes, AreUnderstoodByEveryCommand) {
    const ScratchFolder folder;
    const std::string scene = "generate:cornell_mesh:1000";
    const ProgramRun info = stromboli({"info", scene});
    EXPECT_EQ(info.exitCode, 0) << info.err;
    EXPECT_THAT(info.out, testing::HasSubstr("scene " + scene));
    EXPECT_THAT(info.out, testing::HasSubstr("triangles 1006"));
    const ProgramRun render =
        stromboli({"render", scene, "-o", folder.file("out.png"), "-s", "1", "-r", "8", "8"});
    EXPECT_EQ(render.exitCode, 0) << render.err;
    EXPECT_TRUE(fs::exists(folder.file("out.png")));
    const ProgramRun check = stromboli({"check", scene, "-r", "8", "8", "-s", "64"});
    EXPECT_EQ(check.exitCode, 0) << check.out << check.err;
}

TEST(GeneratedScenes, WrongNameIsOneErrorLine) {
    const ScratchFolder folder;
    const ProgramRun run =
        stromboli({"render", "generate:cornell_mesh:many", "-o", folder.file("out.png")});
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_EQ(run.err, "error: generate:cornell_mesh:many: no such scene; expected "
                       "generate:cornell_mesh:N with N from 1000 to 100000000, or "
                       "generate:lamps:N with N from 8 to 8000000, a multiple of 8, or "
                       "generate:points:N with N from 1 to 8000000, or generate:forest:N "
                       "with N from 1 to 10000000\n");
    EXPECT_EQ(folder.entries().size(), 0u);
}

} // namespace
} // namespace stromboli::test
