// What the file of a picture says of the command that made it.
#include "host/film/image_file.hpp"
#include "host/version/version.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

class Notes : public testing::Test {
  protected:
    ScratchFolder folder;
    std::string scene = libraryScene("cornell_boxes.dae");

    ProgramRun render(const std::string& output, std::vector<std::string> extra) {
        std::vector<std::string> words = {"render", scene, "-o", folder.file(output),
                                          "-r",     "16",  "12"};
        words.insert(words.end(), extra.begin(), extra.end());
        ProgramRun run = stromboli(words);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return run;
    }
    std::string note(const std::string& picture, const std::string& name) const {
        for (const PictureNote& note : readPictureNotes(folder.path() / picture))
            if (note.name == name) return note.text;
        return "none";
    }
    std::string bytesOf(const std::string& name) const {
        std::ifstream file(folder.path() / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
};

TEST_F(Notes, SayHowThePictureWasMade) {
    for (const char* picture : {"a.png", "a.exr"}) {
        render(picture, {"--samples=8", "--seed", "7", "--device", "0", "-q"});
        EXPECT_EQ(note(picture, "Software"), std::string("Stromboli ") + version());
        EXPECT_EQ(note(picture, "Scene"), scene);
        EXPECT_EQ(note(picture, "Seed"), "7");
        EXPECT_EQ(note(picture, "Samples"), "8 a pixel");
        EXPECT_NE(note(picture, "Device"), "none");
        EXPECT_EQ(note(picture, "Command"),
                  "stromboli render " + scene + " -r 16 12 -s 8 --seed 7");
        const ProgramRun info = stromboli({"info", folder.file(picture)});
        EXPECT_EQ(info.exitCode, 0) << info.err;
        EXPECT_THAT(info.out, HasSubstr("  Seed: 7\n"));
        EXPECT_THAT(stromboli({"info", folder.file(picture), "--json", "-"}).out,
                    HasSubstr("\"Seed\": \"7\""));
    }
}

/// Names of files, how much is said, and where the state is kept do not show in a picture.
TEST_F(Notes, OfTheSamePictureAreTheSame) {
    for (const char* kind : {".png", ".exr"}) {
        const std::string a = std::string("a") + kind, b = std::string("b") + kind;
        render(a, {"-s", "4", "--seed", "3"});
        render(b, {"--seed", "3", "--samples", "4", "-v", "-t", "1", "--device", "0", "--stats",
                   folder.file("s.json"), "--checkpoint", folder.file("c")});
        EXPECT_TRUE(bytesOf(a) == bytesOf(b)) << kind;
    }
}

TEST_F(Notes, AreLeftOutOnRequest) {
    for (const char* picture : {"a.png", "a.exr"}) {
        render(picture, {"-s", "4", "--notes", "off"});
        EXPECT_TRUE(readPictureNotes(folder.path() / picture).empty());
    }
    EXPECT_THAT(stromboli({"info", folder.file("a.png")}).out, HasSubstr("says nothing"));
    EXPECT_EQ(stromboli({"info", folder.file("none.png")}).exitCode, 1);
}

TEST_F(Notes, AreInTheRatePictureToo) {
    render("a.png", {"-s", "8", "-a", "4", "0.1"});
    EXPECT_EQ(note("a_rate.png", "Command"),
              "stromboli render " + scene + " -r 16 12 -s 8 -a 4 0.1");
}

TEST_F(Notes, NamesThatBreakLinesDoNotBreakThem) {
    const std::string odd = folder.file("a\nb.dae");
    std::filesystem::copy_file(scene, odd);
    scene = odd;
    render("a.png", {"-s", "1"});
    EXPECT_THAT(note("a.png", "Scene"), HasSubstr("a\\nb.dae"));
}

} // namespace
} // namespace stromboli::test
