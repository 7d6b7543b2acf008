// `stromboli regress` as a user meets it. How pictures are judged: tests/regress.
#include "tests/cli/program.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A suite of two small pictures; `more` is said of the second.
void writeSuite(const ScratchFolder& folder, const std::string& more = "") {
    std::ofstream(folder.file("suite.toml"))
        << "size = [32, 24]\nsamples = 16\n[[picture]]\nscene = \"cornell_boxes\"\n"
           "[[picture]]\nname = \"dim\"\nscene = \"light_point\"\n"
        << more;
}

ProgramRun regress(const ScratchFolder& folder, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"regress", folder.file("suite.toml"), "-o",
                                      folder.file("out")};
    words.insert(words.end(), more.begin(), more.end());
    return stromboli(words);
}

TEST(RegressCommand, GoldenPicturesAreMadeAndHold) {
    const ScratchFolder folder;
    writeSuite(folder);
    ProgramRun run = regress(folder);
    EXPECT_EQ(run.exitCode, kDevice);
    EXPECT_THAT(run.out, AllOf(HasSubstr("no golden"), HasSubstr("--update makes it")));
    run = regress(folder, {"--update"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("2 golden pictures made anew"));
    run = regress(folder);
    EXPECT_EQ(run.exitCode, 0) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr("PASS: 2 of 2 pictures agree"));
    for (const char* file : {"report.html", "results.json", "junit.xml", "dim.exr"})
        EXPECT_TRUE(std::filesystem::exists(folder.file(std::string("out/") + file))) << file;
    EXPECT_THAT(contentOf(folder.file("out/report.html")), HasSubstr("data:image/png;base64,"));
}

TEST(RegressCommand, AChangeIsFoundAndTheOthersGoOn) {
    const ScratchFolder folder;
    writeSuite(folder);
    ASSERT_EQ(regress(folder, {"--update"}).exitCode, 0);
    // Its light comes from elsewhere, and a third picture has no scene.
    writeSuite(folder, "options = \"--look-from 0.1 1 3\"\n[[picture]]\nscene = \"nowhere.dae\"\n");
    const ProgramRun run = regress(folder);
    EXPECT_EQ(run.exitCode, kDevice);
    EXPECT_THAT(run.out, AllOf(HasSubstr("agrees     cornell_boxes"), HasSubstr("differs    dim"),
                               HasSubstr("failed     nowhere")));
    EXPECT_THAT(contentOf(folder.file("out/junit.xml")), HasSubstr("<failure"));
}

TEST(RegressCommand, OptionsThatWouldBeWithoutEffectAreRefused) {
    for (const char* options :
         {"--seed 3", "--seed=3", "--denoise on", "--share 1/2", "--camera all"}) {
        const ScratchFolder folder;
        writeSuite(folder, std::string("options = \"") + options + "\"\n");
        const ProgramRun run = regress(folder, {"--only", "dim"});
        EXPECT_EQ(run.exitCode, kDevice) << options;
        EXPECT_THAT(run.out, HasSubstr("failed     dim")) << options;
    }
}

TEST(RegressCommand, OnePictureAloneAndWhatIsWrongIsSaidBeforeTheWork) {
    const ScratchFolder folder;
    writeSuite(folder);
    const ProgramRun one = regress(folder, {"--update", "--only", "dim"});
    EXPECT_EQ(one.exitCode, 0) << one.err;
    EXPECT_THAT(one.out, AllOf(HasSubstr("dim"), Not(HasSubstr("cornell_boxes"))));
    const ProgramRun none = regress(folder, {"--only", "dimm"});
    EXPECT_EQ(none.exitCode, kUsage);
    EXPECT_THAT(none.err, HasSubstr("no picture 'dimm'"));
    writeSuite(folder, "samples = 16\nframes = 3\n");
    const ProgramRun wrong = regress(folder);
    EXPECT_EQ(wrong.exitCode, kScene);
    EXPECT_THAT(wrong.err, HasSubstr("suite.toml:9: <frames>"));
}

/// One sample tells nothing, and a scene that is not there is worse, wherever it stands.
TEST(CheckCommand, EndsWithTheCodeOfTheWorstScene) {
    const std::vector<std::string> few = {"-r", "16", "12", "-s", "1"};
    const auto codeOf = [&](std::vector<std::string> scenes) {
        scenes.insert(scenes.begin(), "check");
        scenes.insert(scenes.end(), few.begin(), few.end());
        return stromboli(scenes).exitCode;
    };
    EXPECT_EQ(codeOf({"light_point", "cornell_boxes"}), 6);
    EXPECT_EQ(codeOf({"nowhere.dae", "cornell_boxes"}), kScene);
    EXPECT_EQ(codeOf({"cornell_boxes", "nowhere.dae"}), kScene);
}

/// Of several scenes one that is not there costs itself, and the exit code is its own.
TEST(CheckCommand, TakesSeveralScenesAndTellsAllAsJson) {
    const ScratchFolder folder;
    const ProgramRun run = stromboli({"check", "light_point", "nowhere.dae", "cornell_boxes", "-r",
                                      "16", "12", "-s", "32", "--json", folder.file("check.json")});
    EXPECT_EQ(run.exitCode, kScene) << run.err;
    EXPECT_THAT(run.out, AllOf(HasSubstr("light_point\nA: "), HasSubstr("cornell_boxes\nA: ")));
    const auto json = nlohmann::json::parse(contentOf(folder.file("check.json")));
    ASSERT_EQ(json["scenes"].size(), 3u);
    EXPECT_EQ(json["scenes"][0]["verdict"], "agree");
    EXPECT_EQ(json["scenes"][1]["verdict"], "failed");
    EXPECT_EQ(json["scenes"][2]["scene"], "cornell_boxes");
    EXPECT_EQ(json["scenes"][2]["channels"].size(), 3u);
}

} // namespace
} // namespace stromboli::test
