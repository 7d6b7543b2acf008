// Alpha, layers, and a picture of each camera, as users ask for them.
#include "host/film/image_formats.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

/// A grey square of four metres that faces up, and cameras above it that see one of a metre, or
/// six.
std::string floorScene(const std::string& cameras) {
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g" name="floor"><mesh>
<source id="p"><float_array id="f" count="12">-2 0 -2 -2 0 2 2 0 2 2 0 -2</float_array>
<technique_common><accessor source="#f" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount>
<p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>
<library_cameras>)" +
           cameras +
           R"(</library_cameras>
<library_visual_scenes><visual_scene id="s">
<node name="ground"><instance_geometry url="#g"/></node>
<node><rotate>1 0 0 -90</rotate><translate>0 0 3</translate>
<instance_camera url="#a"/></node>
<node><rotate>1 0 0 -90</rotate><translate>0 0 3</translate>
<instance_camera url="#b"/></node>
<node><rotate>1 0 0 -90</rotate><translate>0 0 3</translate>
<instance_camera url="#c"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string camera(const std::string& id, const std::string& name, const std::string& half) {
    return "<camera id=\"" + id + "\" name=\"" + name +
           "\"><optics><technique_common><orthographic><xmag>" + half + "</xmag><ymag>" + half +
           "</ymag></orthographic></technique_common></optics></camera>\n";
}

const std::string kThree =
    floorScene(camera("a", "near", "0.5") + camera("b", "far", "3") + camera("c", "far away", "4"));

class Layers : public testing::Test {
  protected:
    ScratchFolder folder;

    ProgramRun render(std::vector<std::string> words, const std::string& size = "8",
                      const std::string& samples = "16") {
        const std::string scene = folder.write("a.dae", kThree);
        std::vector<std::string> all = {"render", scene, "-r", size, size, "-s", samples};
        all.insert(all.end(), words.begin(), words.end());
        return stromboli(all);
    }
    void expectRefused(std::vector<std::string> words, int code, const std::string& message) {
        const ProgramRun run = render(std::move(words));
        EXPECT_EQ(run.exitCode, code) << run.err;
        EXPECT_THAT(run.err, HasSubstr(message));
        EXPECT_THAT(folder.entries(), ElementsAre("a.dae"));
    }
};

/// Pixels of a metre: the floor covers four by four of the eight.
TEST_F(Layers, TransparentPicturesHaveAlpha) {
    const std::vector<std::string> asked = {"--camera", "far away", "--transparent", "--env", "1",
                                            "--notes",  "off"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), asked.begin(), asked.end());
        const ProgramRun run = render(more);
        EXPECT_EQ(run.exitCode, 0) << run.err;
    };
    with({"-o", folder.file("a.exr")});
    with({"-o", folder.file("a.png")});
    const FloatImage floats = readExr(folder.file("a.exr"));
    const ByteImage bytes = readPng(folder.file("a.png"));
    ASSERT_EQ(bytes.alpha.size(), 64u);
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x) {
            const bool covered = x >= 2 && x < 6 && y >= 2 && y < 6;
            EXPECT_EQ(bytes.alpha[y * 8 + x], covered ? 255 : 0) << x << " " << y;
            EXPECT_EQ(floats.channels.at("A")[y * 8 + x], covered ? 1 : 0);
            EXPECT_NEAR(floats.channels.at("G")[y * 8 + x], covered ? 0.5 : 0, 0.1);
        }
    const ProgramRun run =
        stromboli({"compare", folder.file("a.exr"), folder.file("a.png"), "--max-relmse", "0.001"});
    EXPECT_EQ(run.exitCode, 0) << run.out << run.err;
}

/// The colour of a pixel that is covered in part is that of what covers it: PNG is not multiplied.
TEST_F(Layers, ThePngOfAnEdgeHasTheColorOfWhatIsThere) {
    const ProgramRun run = render(
        {"-o", folder.file("a.png"), "--camera", "2", "--transparent", "--env", "1", "--even"}, "7",
        "256"); // the floor ends within a pixel
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const ByteImage bytes = readPng(folder.file("a.png"));
    const size_t edge = 3 * 7 + 1, inside = 3 * 7 + 3;
    EXPECT_EQ(bytes.alpha[inside], 255);
    EXPECT_NEAR(bytes.alpha[edge], 255.0 * 5 / 6, 255 * 0.03);
    EXPECT_NEAR(bytes.rgb[3 * edge], bytes.rgb[3 * inside], 6);
}

/// In bands, from a checkpoint, and with samples that are spread: the alpha of the samples that
/// there are.
TEST_F(Layers, BandsMakeTheSameBytes) {
    const auto make = [&](const std::string& file, std::vector<std::string> more) {
        more.insert(more.end(),
                    {"-o", folder.file(file), "--camera", "2", "--transparent", "--env", "1",
                     "--even", "--notes", "off", "--layers", "albedo,depth,object"});
        const ProgramRun run = render(more, "72");
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return run.err;
    };
    make("whole.exr", {});
    EXPECT_THAT(make("bands.exr", {"--film-memory", "1"}), HasSubstr("bands"));
    EXPECT_EQ(bytesOf(folder.file("whole.exr")), bytesOf(folder.file("bands.exr")));
}

/// A checkpoint of another kind of picture is none to go on from.
TEST_F(Layers, GoingOnKeepsAlpha) {
    const std::string kept = folder.file("kept");
    const auto go = [&](const std::string& output, const std::string& samples,
                        std::vector<std::string> more) {
        more.insert(more.end(),
                    {"-o", folder.file(output), "--camera", "2", "--env", "1", "--checkpoint", kept,
                     "--notes", "off", "--even", "--branches", "1"});
        return render(more, "8", samples);
    };
    EXPECT_EQ(go("a.exr", "8", {"--transparent"}).exitCode, 0);
    const ProgramRun again = go("a.exr", "24", {"--transparent", "--resume"});
    EXPECT_THAT(again.err, HasSubstr("goes on from"));
    const ProgramRun other = go("b.exr", "24", {"--resume"});
    EXPECT_EQ(other.exitCode, kUsage);
    EXPECT_THAT(other.err, HasSubstr("the checkpoint is of other settings"));
    std::filesystem::remove(kept);
    EXPECT_EQ(go("c.exr", "24", {"--transparent"}).exitCode, 0);
    EXPECT_EQ(bytesOf(folder.file("a.exr")), bytesOf(folder.file("c.exr")));
}

TEST_F(Layers, AreChannelsWithALegend) {
    const ProgramRun run =
        render({"-o", folder.file("a.exr"), "--camera", "far away", "--aov", "--layers",
                "albedo,normal,depth,position,uv,object,material", "--notes", "off"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const FloatImage image = readExr(folder.file("a.exr"));
    std::vector<std::string> names;
    for (const auto& [name, values] : image.channels)
        names.push_back(name);
    EXPECT_THAT(names,
                UnorderedElementsAre("R", "G", "B", "samples", "variance.R", "variance.G",
                                     "variance.B", "albedo.R", "albedo.G", "albedo.B", "normal.X",
                                     "normal.Y", "normal.Z", "depth.Z", "position.X", "position.Y",
                                     "position.Z", "uv.U", "uv.V", "object.X", "material.X"));
    const size_t middle = 4 * 8 + 4;
    EXPECT_NEAR(image.channels.at("depth.Z")[middle], 3, 1e-5);
    EXPECT_NEAR(image.channels.at("normal.Y")[middle], 1, 1e-4);
    EXPECT_NEAR(image.channels.at("albedo.G")[middle], 0.5, 1e-5);
    EXPECT_EQ(image.channels.at("object.X")[middle], 1);
    EXPECT_EQ(image.channels.at("object.X")[0], 0);
    EXPECT_TRUE(std::isinf(image.channels.at("depth.Z")[0]));
    EXPECT_THAT(stromboli({"info", folder.file("a.exr")}).out,
                AllOf(HasSubstr("Objects: [\"ground\"]"), HasSubstr("Materials: [\"default\"]")));
}

TEST_F(Layers, ThatMakeNoSenseAreRefused) {
    const std::string exr = folder.file("a.exr"), png = folder.file("a.png");
    expectRefused({"-o", exr, "--layers", "albedo,teapot"}, kUsage, "--layers is 'teapot'");
    expectRefused({"-o", exr, "--layers", ""}, kUsage, "--layers");
    expectRefused({"-o", exr, "--layers", "uv,albedo,uv"}, kUsage, "--layers names uv twice");
    expectRefused({"-o", png, "--layers", "albedo"}, kUsage,
                  "--layers needs an EXR file (-o name.exr)");
    expectRefused({"-o", png, "--camera", "all", "--stats", "-"}, kUsage, "--stats -");
    expectRefused({"-o", "-", "--camera", "1,2"}, kUsage, "-o - has place for one picture");
    expectRefused({"-o", png, "--camera", "1,,2"}, kUsage, "--camera");
    expectRefused({"-o", png, "--camera", "1,near"}, kUsage, "names camera 1 'near' twice");
    expectRefused({"-o", png, "--camera", "1,7"}, kScene, "has no camera '7'; it has 1 'near'");
    EXPECT_THAT(stromboli({"info", folder.file("a.dae"), "--camera", "all"}).err,
                HasSubstr("only render"));
}

TEST_F(Layers, ATransparentPictureOfASkySaysSo) {
    const std::string empty =
        folder.write("sky.xml", "<scene version='3.0.0'><emitter type='constant'/></scene>");
    const ProgramRun run = stromboli(
        {"render", empty, "-o", folder.file("a.png"), "--transparent", "-r", "4", "3", "-s", "1"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("has no surfaces: the picture is all transparent"));
    EXPECT_THAT(readPng(folder.file("a.png")).alpha, testing::Each(0));
}

/// Each has the bytes that it has by itself, and a name that can be told.
TEST_F(Layers, ThereIsAPictureOfEachCamera) {
    const ProgramRun run = render({"-o", folder.file("out.png"), "--camera", "all"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(folder.entries(),
                UnorderedElementsAre("a.dae", "out.near.png", "out.far.png", "out.3.png"));
    ASSERT_EQ(render({"-o", folder.file("alone.png"), "--camera", "3"}).exitCode, 0);
    EXPECT_EQ(bytesOf(folder.file("alone.png")), bytesOf(folder.file("out.3.png")));
}

TEST_F(Layers, AListOfCamerasMakesThose) {
    ASSERT_EQ(
        render({"-o", folder.file("o.exr"), "--camera", "3,near", "--stats", folder.file("s.json")})
            .exitCode,
        0);
    EXPECT_THAT(folder.entries(),
                UnorderedElementsAre("a.dae", "o.near.exr", "o.3.exr", "s.near.json", "s.3.json"));
}

} // namespace
} // namespace stromboli::test
