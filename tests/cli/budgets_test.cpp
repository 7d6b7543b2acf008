// What a render may take, and how far it says it is.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string outputOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Budgets : public testing::Test {
  protected:
    ScratchFolder folder;
    std::string scene = libraryScene("cornell_spheres.dae");
};

/// An estimate before the first sample: what cannot fit is an error, a film that cannot comes in
/// bands, and the bytes are those of the picture as a whole.
TEST_F(Budgets, KeepsWithinTheMemoryThatItIsAllowed) {
    const auto run = [&](const std::string& output, const std::string& width,
                         std::vector<std::string> extra) {
        std::vector<std::string> words = {"render", scene, "-o",    folder.file(output), "-s", "1",
                                          "-m",     "0",   "--even"};
        words.insert(words.end(), {"-r", width, "600"});
        words.insert(words.end(), extra.begin(), extra.end());
        return stromboli(words);
    };
    const ProgramRun small = run("a.png", "16", {"--max-memory", "1"});
    EXPECT_EQ(small.exitCode, 1);
    EXPECT_THAT(small.err, testing::ContainsRegex(
                               "--max-memory allows 1 MiB, and the render needs about [0-9]+ MiB: "
                               "[0-9]+ so far, [0-9]+ for the scene, [0-9]+ for the film"));
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.png")));
    EXPECT_EQ(run("a.png", "16", {"--max-memory", "x"}).exitCode, 1);
    const ProgramRun large = run("a.png", "16", {"--max-memory", "8GiB"});
    EXPECT_EQ(large.exitCode, 0);
    const std::string before = "memory: about ";
    const size_t said = large.err.find(before);
    ASSERT_NE(said, std::string::npos) << large.err;
    const int needed = std::stoi(large.err.substr(said + before.size()));
    EXPECT_THAT(large.err, Not(HasSubstr("bands")));

    // Its film is larger than what is left.
    const ProgramRun bands = run("bands.exr", "900", {"--max-memory", std::to_string(needed + 40)});
    EXPECT_EQ(bands.exitCode, 0) << bands.err;
    EXPECT_THAT(bands.err, testing::ContainsRegex("rendering [0-9]+ bands"));
    ASSERT_EQ(run("whole.exr", "900", {}).exitCode, 0);
    EXPECT_TRUE(outputOf(folder.file("whole.exr")) == outputOf(folder.file("bands.exr")));
}

/// Whatever paths share of a sample.
TEST_F(Budgets, ProgressCountsTheSamplesOfTheReport) {
    for (const char* branches : {"1", "4"}) {
        const ProgramRun run = stromboli({"render", scene, "-o", folder.file("a.png"), "-r", "24",
                                          "18", "-s", "8", "--branches", branches, "--progress",
                                          "json", "--stats", folder.file("s.json")});
        ASSERT_EQ(run.exitCode, 0) << run.err;
        const size_t last = run.err.rfind("\"samples\":");
        ASSERT_NE(last, std::string::npos) << run.err;
        const auto json = nlohmann::json::parse(std::ifstream(folder.file("s.json")));
        EXPECT_EQ(std::stoull(run.err.substr(last + 10)), json["samplesTaken"].get<uint64_t>())
            << branches << run.err;
    }
}

} // namespace
} // namespace stromboli::test
