// What is printed, and what becomes of it where it cannot be written.
#include "host/film/image_formats.hpp"
#include "shaders/shared/bsdf_types.h"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Printing : public testing::Test {
  protected:
    ScratchFolder folder;
    const std::string scene = libraryScene("light_point.dae");

    std::vector<std::string> render(std::vector<std::string> more) const {
        std::vector<std::string> words = {"render", scene, "-r", "8", "6", "-s", "2"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

TEST_F(Printing, ThatFailsIsAnErrorOfEveryCommandThatPrints) {
    ASSERT_EQ(stromboli(render({"-o", folder.file("a.png")})).exitCode, 0);
    const std::string picture = folder.file("a.png");
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"info", scene},
             {"devices"},
             {"compare", picture, picture},
             {"stress", "--list"},
             {"study", "--list"},
             {"check", scene, "-r", "8", "6", "-s", "4"},
             {"render", scene, "--pixel", "1", "1", "--sample", "0"},
             {"info", scene, "--json", "-"},
             render({"-o", "-"}),
             {"--help"},
             {"render", "--help"},
             {"--version"}}) {
        const ProgramRun run = stromboli(words, "", ">/dev/full");
        EXPECT_EQ(run.exitCode, 4) << words[0] << " " << run.err;
        EXPECT_THAT(run.err, HasSubstr("error: standard output: cannot write: ")) << words[0];
    }
}

TEST_F(Printing, ToAClosedOutputFailsAndHarmsNoFile) {
    EXPECT_EQ(stromboli({"devices"}, "", ">&-").exitCode, 4);
    const ProgramRun run =
        stromboli(render({"-o", folder.file("a.png"), "--stats", "-"}), "", ">&-");
    EXPECT_EQ(run.exitCode, 4);
    EXPECT_EQ(readPng(folder.file("a.png")).width, 8u);
}

TEST_F(Printing, APictureToStandardOutputIsTheOneInTheFile) {
    const ProgramRun run = stromboli(render({"-o", "-"}));
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(stromboli(render({"-o", folder.file("a.png")})).exitCode, 0);
    std::ostringstream file;
    file << std::ifstream(folder.file("a.png"), std::ios::binary).rdbuf();
    EXPECT_EQ(run.out, file.str());
    EXPECT_THAT(folder.entries(), ElementsAre("a.png"));
}

TEST_F(Printing, StatisticsToStandardOutputAreJson) {
    const ProgramRun run = stromboli(render({"-o", folder.file("a.png"), "--stats", "-"}));
    EXPECT_EQ(nlohmann::json::parse(run.out)["samplesTaken"], 8 * 6 * 2);
    EXPECT_EQ(stromboli(render({"-o", "-", "--stats", "-"})).exitCode, 1);
}

TEST_F(Printing, InfoAsJsonHasWhatTheTextHas) {
    const ProgramRun run = stromboli(
        {"info", libraryScene("cornell_mirror_glass.dae"), "-r", "40", "30", "--json", "-"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["scene"]["spheres"], 2);
    EXPECT_EQ(json["picture"]["width"], 40);
    EXPECT_GT(json["bvh"]["leaves"], 0);
    const auto materials = std::ranges::find_if(
        json["kernel"], [](const auto& feature) { return feature["name"] == "CLOSURES"; });
    EXPECT_EQ((*materials)["label"], "materials");
    EXPECT_THAT((*materials)["text"], testing::AllOf(HasSubstr("mirror"), HasSubstr("dielectric")));
    EXPECT_EQ(uint32_t((*materials)["value"]) & gpu::LOBE_MASK, // with the diffuse walls
              gpu::LOBE_DIFFUSE_REFLECTION | gpu::LOBE_DELTA_REFLECTION |
                  gpu::LOBE_DELTA_TRANSMISSION);
    uint64_t bytes = 0;
    for (const auto& buffer : json["buffers"])
        bytes += buffer["bytes"].get<uint64_t>();
    EXPECT_GT(bytes, 40u * 30 * 16);
}

} // namespace
} // namespace stromboli::test
