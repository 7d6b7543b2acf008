// Sequences: pictures with numbers, of a turntable and of an animation, made in one process.
#include "host/cli/sequence.hpp"

#include "host/core/error.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A triangle that goes from x = 0 to x = 4 in a second.
const std::string kMoving = R"({"asset": {"version": "2.0"}, "scene": 0,
"scenes": [{"nodes": [0, 1]}],
"nodes": [{"mesh": 0}, {"camera": 0, "translation": [2, 0, 6]}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
 "samplers": [{"input": 1, "output": 2}]}],
"accessors": [
 {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
 {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
 {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
 {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
"buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,)"
                            "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"
                            "AAAAAAAAgD8AAAAAAAAAAAAAAAAAAIBAAAAAAAAAAAA="
                            R"("}]})";

class Sequence : public testing::Test {
  protected:
    ScratchFolder folder;

    ProgramRun render(std::vector<std::string> words) {
        words.insert(words.begin(), "render");
        for (const char* word : {"-r", "24", "16", "-s", "4", "--even", "-q"})
            words.emplace_back(word);
        return stromboli(words);
    }

    /// The file in the folder.
    std::string picture(const std::string& name) { return bytesOf(folder.file(name)); }
};

TEST(FrameFiles, HaveNumbersAsFfmpegWantsThem) {
    EXPECT_EQ(fileOfFrame("a.png", 7), "a.0007.png");
    EXPECT_EQ(fileOfFrame("b/a.exr", 123456), "b/a.123456.exr");
    EXPECT_EQ(fileOfFrame("b/a%04d.png", 7), "b/a0007.png");
    EXPECT_EQ(fileOfFrame("a_%02d_x.png", 123), "a_123_x.png");
    EXPECT_EQ(fileOfFrame("%d.png", 12), "12.png");
}

TEST(FrameNumbers, AreARangeOrOne) {
    EXPECT_EQ(readFrames("--frames", "3..17").first, 3u);
    EXPECT_EQ(readFrames("--frames", "3..17").last, 17u);
    EXPECT_EQ(readFrames("--frames", "5").last, 5u);
    for (const char* word : {"3-17", "3:17"}) {
        EXPECT_EQ(readFrames("--frames", word).first, 3u);
        EXPECT_EQ(readFrames("--frames", word).last, 17u);
    }
    for (const char* wrong : {"", "..", "3..", "..4", "4..3", "4-3", "3-", "-4", "-1..2", "1..1e9"})
        EXPECT_THROW(readFrames("--frames", wrong), UsageError) << wrong;
}

TEST(Turntable, TurnsCounterClockwise) {
    RenderOptions asked;
    asked.sequence.turntable = 4;
    const std::vector<RenderOptions> frames = optionsOfFrames(asked);
    ASSERT_EQ(frames.size(), 4u);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(frames[i].picture.camera.turn, 1.5707963267948966 * double(i), 1e-12);
}

TEST_F(Sequence, TurntableHasTheBytesOfItsFramesAlone) {
    const std::string scene = libraryScene("cornell_boxes.dae");
    const ProgramRun all =
        render({scene, "--camera", "frame", "--turntable", "5", "-o", folder.file("a%02d.png")});
    ASSERT_EQ(all.exitCode, 0) << all.err;
    EXPECT_THAT(folder.entries(), testing::UnorderedElementsAre("a00.png", "a01.png", "a02.png",
                                                                "a03.png", "a04.png"));
    const ProgramRun one = render({scene, "--camera", "frame", "--turntable", "5", "--frames",
                                   "3..3", "-o", folder.file("b.png")});
    ASSERT_EQ(one.exitCode, 0) << one.err;
    EXPECT_NE(picture("a03.png"), "");
    EXPECT_EQ(picture("a03.png"), picture("b.0003.png"));
    EXPECT_NE(picture("a03.png"), picture("a02.png"));
}

/// Which of five pictures are rendered is seen by what is in their place: each is replaced by a
/// text.
TEST_F(Sequence, FinishedFramesAreNotRenderedAgain) {
    const std::string scene = libraryScene("cornell_boxes.dae");
    const auto run = [&](const std::string& how) {
        std::vector<std::string> words = {
            "render", scene, "--turntable", "5",  "-o", folder.file("a%d.png"),
            "-r",     "24",  "16",          "-s", "4"};
        if (!how.empty()) words.push_back(how);
        const ProgramRun all = stromboli(words);
        EXPECT_EQ(all.exitCode, 0) << all.err;
        return all.err;
    };
    run("");
    const std::string second = picture("a2.png");
    for (const char* how : {"--resume", "--skip-existing"}) {
        for (const char* name : {"a0.png", "a1.png", "a3.png", "a4.png"})
            folder.write(name, "another");
        std::filesystem::remove(folder.file("a2.png"));
        EXPECT_THAT(run(how), AllOf(HasSubstr("4 of 5 pictures are there already"),
                                    Not(HasSubstr("begins anew"))));
        for (const char* name : {"a0.png", "a1.png", "a3.png", "a4.png"})
            EXPECT_EQ(picture(name), "another");
        EXPECT_EQ(picture("a2.png"), second);
    }
    EXPECT_THAT(run("--skip-existing"), HasSubstr("5 of 5 pictures are there already"));
    // What a checkpoint is left of is not finished.
    folder.write("a3.png.checkpoint", "no checkpoint");
    EXPECT_THAT(render({scene, "--turntable", "5", "-o", folder.file("a%d.png"), "--resume"}).err,
                HasSubstr("a3.png.checkpoint"));
    run("");
    EXPECT_EQ(picture("a2.png"), second);
    EXPECT_NE(picture("a0.png"), "another");
}

TEST_F(Sequence, AnimationHasTheBytesOfItsFramesAlone) {
    const std::string scene = folder.write("a.gltf", kMoving);
    const ProgramRun all =
        render({scene, "--frames", "0..3", "--fps", "4", "-o", folder.file("a.png")});
    ASSERT_EQ(all.exitCode, 0) << all.err;
    const ProgramRun one =
        render({scene, "--frames", "2", "--fps", "4", "-o", folder.file("b.png")});
    ASSERT_EQ(one.exitCode, 0) << one.err;
    EXPECT_NE(picture("a.0002.png"), "");
    EXPECT_EQ(picture("a.0002.png"), picture("b.0002.png"));
    EXPECT_NE(picture("a.0002.png"), picture("a.0001.png")) << "it moves";
}

/// What stands still, here a floor of another mesh and the picture on it, is built and read once.
TEST_F(Sequence, MovingAmongWhatStandsStillHasTheBytesOfItsFramesAlone) {
    std::string text = kMoving;
    const auto replace = [&](const std::string& what, const std::string& by) {
        text.replace(text.find(what), what.size(), by);
    };
    replace(R"("scenes": [{"nodes": [0, 1]}])", R"("scenes": [{"nodes": [0, 1, 2]}])");
    replace(R"({"camera": 0, "translation": [2, 0, 6]}])",
            R"({"camera": 0, "translation": [2, 0, 6]},
  {"mesh": 1, "translation": [2, -1, 0], "scale": [3, 1, 1]}])");
    replace(R"("meshes": [)", R"("images": [{"uri": "a.png"}], "textures": [{"source": 0}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
"meshes": [)");
    replace(R"("POSITION": 0}}]}])", R"("POSITION": 0}}]},
 {"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}])");
    const std::string scene = folder.write("a.gltf", text);
    ASSERT_EQ(stromboli({"render", libraryScene("cornell_boxes.dae"), "-r", "8", "8", "-s", "1",
                         "-q", "-o", folder.file("a.png")})
                  .exitCode,
              0);
    const std::vector<std::string> sky = {"--env", "evening_sky", "--fps", "4"};
    const auto frames = [&](const std::string& numbers, const std::string& output) {
        std::vector<std::string> words = {scene, "--frames", numbers, "-o", folder.file(output)};
        words.insert(words.end(), sky.begin(), sky.end());
        const ProgramRun run = render(words);
        EXPECT_EQ(run.exitCode, 0) << run.err;
    };
    frames("0..3", "all.png");
    for (const std::string number : {"0", "2", "3"}) {
        frames(number, "one.png");
        EXPECT_NE(picture("all.000" + number + ".png"), "");
        EXPECT_EQ(picture("all.000" + number + ".png"), picture("one.000" + number + ".png"));
    }
    EXPECT_NE(picture("all.0002.png"), picture("all.0001.png")) << "it moves";
}

/// But for the words of how they were made.
TEST_F(Sequence, FramesAreMomentsOfTheAnimation) {
    const std::string scene = folder.write("a.gltf", kMoving);
    render({scene, "--frames", "3", "--fps", "4", "--notes", "off", "-o", folder.file("a.png")});
    render({scene, "--at", "0.75", "--notes", "off", "-o", folder.file("b.png")});
    EXPECT_NE(picture("b.png"), "");
    EXPECT_EQ(picture("a.0003.png"), picture("b.png"));
}

TEST_F(Sequence, WhatDoesNotGoTogetherIsRefused) {
    const std::string scene = libraryScene("cornell_boxes.dae"), out = folder.file("a.png");
    const auto refused = [&](const std::vector<std::string>& words, const std::string& message) {
        std::vector<std::string> all = {scene};
        all.insert(all.end(), words.begin(), words.end());
        const ProgramRun run = render(all);
        EXPECT_EQ(run.exitCode, kUsage) << message;
        EXPECT_THAT(run.err, HasSubstr(message));
    };
    refused({"-o", out, "--turntable", "0"}, "--turntable");
    refused({"-o", out, "--turntable", "4", "--frames", "2..4"}, "0 to 3");
    refused({"-o", out, "--turntable", "4", "--camera", "all"}, "--camera names several");
    refused({"-o", "-", "--turntable", "4"}, "place for one picture");
    refused({"-o", out, "--frames", "4..2"}, "--frames");
    refused({"-o", out, "--fps", "4"}, "--frames");
    refused({"-o", out, "--frames", "2", "--at", "1"}, "--at");
    for (const char* how : {"--resume", "--skip-existing"})
        refused({"-o", out, "--turntable", "2", "--checkpoint", "off", how}, "--checkpoint is off");
    EXPECT_THAT(folder.entries(), ElementsAre());
}

TEST_F(Sequence, FramesOfAFileWithoutAnimationAreRefused) {
    const ProgramRun run =
        render({libraryScene("cornell_boxes.dae"), "--frames", "2", "-o", folder.file("a.png")});
    EXPECT_EQ(run.exitCode, kScene) << run.err;
    EXPECT_THAT(run.err, HasSubstr("--frames"));
}

} // namespace
} // namespace stromboli::test
