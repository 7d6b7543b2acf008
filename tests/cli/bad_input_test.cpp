// Bad input gives one clear line, the right exit code, and leaves nothing behind.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kHead = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
)";

/// A document with one triangle mesh; the parts that tests spoil are arguments.
std::string document(const std::string& positions, const std::string& indices,
                     const std::string& count = "9", const std::string& source = "#positions") {
    return kHead + R"(<library_geometries><geometry id="g"><mesh>
<source id="positions"><float_array id="f" count=")" +
           count + "\">" + positions + R"(</float_array><technique_common>
<accessor source="#f" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source=")" +
           source + R"("/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
           indices + R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

const std::string kGood = document("0 0 0 1 0 0 0 1 0", "0 1 2");

class BadInput : public testing::Test {
  protected:
    ScratchFolder folder;

    ProgramRun renderFile(const std::string& scene, std::vector<std::string> extra = {}) {
        std::vector<std::string> arguments = {
            "render", scene, "-o", folder.file("out.png"), "-s", "1", "-r", "8", "8"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        return stromboli(arguments);
    }

    /// One error line that says what is wrong; nothing written.
    void expectRefused(const ProgramRun& run, int exitCode, const std::string& message) {
        EXPECT_EQ(run.exitCode, exitCode) << run.err;
        EXPECT_THAT(run.err, HasSubstr(message));
        size_t errors = 0;
        for (size_t at = run.err.find("error:"); at != std::string::npos;
             at = run.err.find("error:", at + 1))
            ++errors;
        EXPECT_EQ(errors, 1u) << run.err;
        EXPECT_THAT(folder.entries(), testing::Not(testing::Contains("out.png")));
    }

    void expectSceneRefused(const std::string& text, const std::string& message,
                            const std::string& name = "bad.dae") {
        expectRefused(renderFile(folder.write(name, text)), kScene, message);
    }
};

TEST_F(BadInput, GoodDocumentIsRendered) {
    const ProgramRun run = renderFile(folder.write("good.dae", kGood));
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("no camera"), HasSubstr("no light")));
    EXPECT_THAT(folder.entries(), testing::Contains("out.png"));
}

TEST_F(BadInput, MissingFile) {
    expectRefused(renderFile(folder.file("none.dae")), kScene, "none.dae");
}
TEST_F(BadInput, Directory) {
    expectRefused(renderFile(folder.path().string()), kScene, "");
}
TEST_F(BadInput, NotXml) {
    expectSceneRefused("solid cube", "bad.dae");
}
TEST_F(BadInput, EmptyFile) {
    expectSceneRefused("", "bad.dae");
}
TEST_F(BadInput, TruncatedXml) {
    expectSceneRefused(kGood.substr(0, kGood.size() / 2), "bad.dae");
}
TEST_F(BadInput, NotCollada) {
    expectSceneRefused("<svg></svg>", "COLLADA");
}
TEST_F(BadInput, DanglingId) {
    expectSceneRefused(document("0 0 0 1 0 0 0 1 0", "0 1 2", "9", "#nowhere"), "nowhere");
}
TEST_F(BadInput, WrongCount) {
    expectSceneRefused(document("0 0 0 1 0 0 0 1 0", "0 1 2", "12"), "bad.dae:");
}
TEST_F(BadInput, IndexOutOfRange) {
    expectSceneRefused(document("0 0 0 1 0 0 0 1 0", "0 1 7"), "bad.dae:");
}
TEST_F(BadInput, NotANumber) {
    expectSceneRefused(document("0 0 0 1 0 0 0 x 0", "0 1 2"), "bad.dae:");
}
TEST_F(BadInput, NanAndInfinityAreNotNumbers) {
    expectSceneRefused(document("0 0 0 1 0 0 0 NaN 0", "0 1 2"), "bad.dae:");
    expectSceneRefused(document("0 0 0 1 0 0 0 INF 0", "0 1 2"), "bad.dae:");
}

/// What leaves nothing to draw is an error, whatever the format; lamps alone are not seen.
TEST_F(BadInput, NothingToDraw) {
    const std::pair<const char*, std::string> files[] = {
        {"empty.dae", kHead + "<library_visual_scenes><visual_scene id='s'/>"
                              "</library_visual_scenes><scene><instance_visual_scene url='#s'/>"
                              "</scene></COLLADA>"},
        {"empty.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{}], "scene": 0})"},
        {"empty.xml", "<scene version='3.0.0'><emitter type='point'/></scene>"},
        {"dark.xml", "<scene version='3.0.0'><emitter type='constant'>"
                     "<rgb name='radiance' value='0'/></emitter></scene>"},
        {"empty.pbrt", "WorldBegin\nLightSource \"point\"\n"}};
    for (const auto& [name, text] : files)
        expectSceneRefused(text, "has nothing to draw: expected surfaces", name);
}

/// A sky is something to draw, that of the file or that of the command line.
TEST_F(BadInput, ASkyAloneIsDrawn) {
    const std::string lit =
        folder.write("sky.xml", "<scene version='3.0.0'><emitter type='constant'/></scene>");
    const std::string bare =
        folder.write("bare.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{}], "scene": 0})");
    for (const ProgramRun& run : {renderFile(lit), renderFile(bare, {"--env", "evening_sky"})}) {
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr("has no surfaces: the picture is of what is around it"));
        EXPECT_THAT(run.err, Not(HasSubstr("black")));
    }
}

TEST_F(BadInput, APartOfABackgroundIsSaid) {
    // A TGA of two rows of one grey pixel, of which the second is not there.
    const std::string part =
        folder.write("part.tga", std::string("\0\0\3\0\0\0\0\0\0\0\0\0\1\0\2\0\x08\x20\7", 19));
    const ProgramRun run = renderFile(folder.write("good.dae", kGood), {"--background", part});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("part.tga: the file is truncated: what there is of it"));
}

TEST_F(BadInput, CameraFromAFileWithoutOne) {
    expectRefused(renderFile(folder.write("good.dae", kGood), {"--camera", "file"}), kScene,
                  "camera");
}

TEST_F(BadInput, UnknownOption) {
    expectRefused(renderFile(folder.write("good.dae", kGood), {"--sampels", "3"}), kUsage,
                  "--sampels");
}
TEST_F(BadInput, ZeroSamples) {
    expectRefused(stromboli({"render", libraryScene("light_point.dae"), "-o",
                             folder.file("out.png"), "-s", "0"}),
                  kUsage, "-s");
}
TEST_F(BadInput, AbsurdSize) {
    expectRefused(stromboli({"render", libraryScene("light_point.dae"), "-o",
                             folder.file("out.png"), "-r", "0", "5"}),
                  kUsage, "width");
    expectRefused(stromboli({"render", libraryScene("light_point.dae"), "-o",
                             folder.file("out.png"), "-r", "900000", "5"}),
                  kUsage, "width");
}
TEST_F(BadInput, CropOutsideThePicture) {
    expectRefused(renderFile(libraryScene("light_point.dae"), {"--crop", "4", "4", "8", "8"}),
                  kUsage, "--crop");
}

TEST_F(BadInput, OutputFolderMissing) {
    const ProgramRun run = stromboli(
        {"render", libraryScene("light_point.dae"), "-o", folder.file("nowhere/out.png")});
    expectRefused(run, kOutput, "nowhere");
}
TEST_F(BadInput, OutputOfUnknownKind) {
    expectRefused(
        stromboli({"render", libraryScene("light_point.dae"), "-o", folder.file("out.gif")}),
        kUsage, "out.gif");
}
TEST_F(BadInput, OutputNotWritable) {
    expectRefused(stromboli({"render", libraryScene("light_point.dae"), "-o", "/proc/out.png"}),
                  kOutput, "/proc/out.png");
}
TEST_F(BadInput, StatisticsNotWritable) {
    expectRefused(
        renderFile(libraryScene("light_point.dae"), {"--stats", folder.file("nowhere/s.json")}),
        kOutput, "nowhere");
}

TEST_F(BadInput, OutputsInOneFile) {
    expectRefused(renderFile(libraryScene("light_point.dae"), {"--stats", folder.file("out.png")}),
                  kUsage, "same file");
}
TEST_F(BadInput, PictureLargerThanMemory) {
    expectRefused(
        stromboli({"render", libraryScene("light_point.dae"), "-o", folder.file("out.png"), "-r",
                   "65536", "65536", "--backend", "reference"}),
        kUsage, "memory");
}

TEST_F(BadInput, UnknownDevice) {
    expectRefused(renderFile(libraryScene("light_point.dae"), {"--device", "voodoo"}), kDevice,
                  "no device matches 'voodoo'; there is llvmpipe");
    expectRefused(renderFile(libraryScene("light_point.dae"), {"--device", "99"}), kDevice, "99");
}

TEST_F(BadInput, NoDevice) {
    // The loader finds no driver when told to look in an empty place.
    const ProgramRun run =
        stromboli({"render", libraryScene("light_point.dae"), "-o", folder.file("out.png")},
                  "VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent");
    EXPECT_EQ(run.exitCode, kDevice) << run.err;
    EXPECT_THAT(run.err, HasSubstr("mesa-vulkan-drivers"));
}

TEST_F(BadInput, OldPictureSurvivesAFailure) {
    folder.write("out.png", "precious");
    const ProgramRun run = renderFile(folder.file("none.dae"));
    EXPECT_EQ(run.exitCode, kScene);
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out.png"});
    EXPECT_EQ(std::filesystem::file_size(folder.path() / "out.png"), 8u);
}

} // namespace
} // namespace stromboli::test
