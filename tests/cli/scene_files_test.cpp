// Scene files as they are found: what is taken for what they leave open, what is forgiven, which of
// their cameras is taken, and names instead of files.
#include "host/film/image_formats.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/cpu_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string camera(const std::string& id, const std::string& transform) {
    return "<node>" + transform + "<instance_camera url=\"#" + id + "\"/></node>";
}

/// Looks down from y = 3 at a square of one metre.
const std::string kFromAbove =
    camera("c", "<rotate>1 0 0 -90</rotate><translate>0 0 3</translate>");
const std::string kAway = camera("c", "<rotate>1 0 0 90</rotate><translate>0 0 -3</translate>");

/// A square floor of four metres that faces up, without a light, seen by a camera of one metre.
std::string floorScene(const std::string& nodes = kFromAbove, const std::string& libraries = "",
                       const std::string& material = "") {
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_cameras><camera id="c" name="above"><optics><technique_common><orthographic>
<xmag>0.5</xmag><ymag>0.5</ymag></orthographic></technique_common></optics></camera>
<camera id="d" name="beside"><optics><technique_common><perspective><xfov>30</xfov>
</perspective></technique_common></optics></camera></library_cameras>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count="12">-2 0 -2 -2 0 2 2 0 2 2 0 -2</float_array>
<technique_common><accessor source="#f" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount>
<p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>
)" + libraries +
           R"(<library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g">)" +
           material + "</instance_geometry></node>\n" + nodes + R"(</visual_scene>
</library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

class SceneFiles : public testing::Test {
  protected:
    ScratchFolder folder;

    ProgramRun render(const std::string& scene, std::vector<std::string> extra = {}) {
        std::vector<std::string> arguments = {
            "render", scene, "-o", folder.file("out.exr"), "-r", "8", "8", "-s", "64"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        return stromboli(arguments);
    }

    double meanRadiance(const std::vector<std::string>& extra) {
        const ProgramRun run = render(folder.write("a.dae", floorScene()), extra);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        const FloatImage image = readExr(folder.file("out.exr"));
        double sum = 0;
        for (const float value : image.channels.at("G"))
            sum += double(value);
        return sum / 64;
    }
};

/// A grey floor reflects half of a sky of radiance 1. The mean is of 4096 samples, none of which is
/// further from it than the mean itself is from 0 and 1: five standard errors are 0.04.
TEST_F(SceneFiles, WithoutALightTheSkyLightsThem) {
    EXPECT_NEAR(meanRadiance({}), 0.5, 0.04);
    EXPECT_EQ(meanRadiance({"--default-light", "off"}), 0);
    EXPECT_EQ(meanRadiance({"--cs184", "--camera", "file"}), 0);
}

TEST_F(SceneFiles, WhatIsTakenForALightIsSaid) {
    const std::string scene = folder.write("a.dae", floorScene());
    EXPECT_THAT(render(scene).err, AllOf(HasSubstr("no light"), HasSubstr("--default-light off")));
    EXPECT_THAT(render(scene, {"--default-light", "off"}).err,
                AllOf(HasSubstr("warning: "), HasSubstr("no light: the picture is black")));
    EXPECT_THAT(stromboli({"info", scene}).out, HasSubstr("plain sky"));
    EXPECT_THAT(render(scene, {"--cs184"}).err, HasSubstr("no light: the picture is black"));
    EXPECT_THAT(render(scene, {"--cs184", "--default-light", "on"}).err, HasSubstr("plain sky"));
}

TEST_F(SceneFiles, StrictMakesWhatIsForgivenAnError) {
    const std::string missing = "<bind_material><technique_common><instance_material symbol=\"m\" "
                                "target=\"#gone\"/></technique_common></bind_material>";
    const std::string scene = folder.write("a.dae", floorScene(kFromAbove, "", missing));
    const ProgramRun forgiven = render(scene);
    EXPECT_EQ(forgiven.exitCode, 0) << forgiven.err;
    EXPECT_THAT(forgiven.err, HasSubstr("a.dae:15: <instance_material>: target=\"#gone\""));
    EXPECT_THAT(stromboli({"info", scene}).out, HasSubstr("forgiven: "));
    std::filesystem::remove(folder.file("out.exr"));
    const ProgramRun strict = render(scene, {"--strict"});
    EXPECT_EQ(strict.exitCode, kScene);
    EXPECT_THAT(strict.err, HasSubstr("error: " + scene + ":15: <instance_material>: "));
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"a.dae"});
}

TEST_F(SceneFiles, ACameraThatSeesNothingIsSaidTo) {
    const std::string away = folder.write("away.dae", floorScene(kAway));
    const ProgramRun nothing = render(away);
    EXPECT_EQ(nothing.exitCode, 0) << nothing.err;
    EXPECT_THAT(nothing.err, AllOf(HasSubstr("camera 'above' sees nothing of the scene"),
                                   HasSubstr("--camera frame")));
    EXPECT_THAT(render(away, {"--camera", "frame"}).err, Not(HasSubstr("sees nothing")));
    EXPECT_THAT(render(folder.write("at.dae", floorScene())).err, Not(HasSubstr("sees nothing")));
}

TEST_F(SceneFiles, CamerasAreTakenByNameOrNumber) {
    const std::string scene =
        folder.write("a.dae", floorScene(kFromAbove + camera("d", "<translate>0 0 9</translate>")));
    EXPECT_THAT(render(scene).err, HasSubstr("camera 'above', the first of 2"));
    const std::string listed = stromboli({"info", scene}).out;
    EXPECT_THAT(listed, AllOf(HasSubstr("camera 1 'above', orthographic: taken"),
                              HasSubstr("camera 2 'beside', perspective\n")));
    for (const char* second : {"2", "beside"})
        EXPECT_THAT(stromboli({"info", scene, "--camera", second}).out,
                    AllOf(HasSubstr("camera 2 'beside', perspective: taken"),
                          HasSubstr("perspective camera at (0, 0, 9)")));
    const ProgramRun wrong = render(scene, {"--camera", "below"});
    EXPECT_EQ(wrong.exitCode, kScene);
    EXPECT_THAT(wrong.err, HasSubstr("has no camera 'below'; it has 1 'above', 2 'beside'"));
    EXPECT_EQ(render(scene, {"--camera", ""}).exitCode, kUsage);
}

TEST_F(SceneFiles, FramingInPlaceOfTheFilesCameraIsSaid) {
    const std::string dialect =
        "<library_effects><effect id=\"e\"><extra><technique profile=\"CGL\"/></extra></effect>"
        "</library_effects>\n";
    const std::string scene = folder.write("a.dae", floorScene(kFromAbove, dialect));
    EXPECT_THAT(render(scene).err,
                AllOf(HasSubstr("framing the whole scene"), HasSubstr("camera 'above'")));
    EXPECT_THAT(render(scene, {"--camera", "file"}).err, Not(HasSubstr("framing")));
}

TEST_F(SceneFiles, BundledScenesHaveNames) {
    EXPECT_EQ(render("light_point").exitCode, 0);
    EXPECT_THAT(stromboli({"info", "light_point"}).out, HasSubstr("light_point.dae"));
    const ProgramRun wrong = render("light_piont");
    EXPECT_EQ(wrong.exitCode, kScene);
    EXPECT_THAT(wrong.err, AllOf(HasSubstr("light_piont"), HasSubstr("did you mean light_point?")));
    EXPECT_THAT(render("nothing_like_it").err,
                AllOf(HasSubstr("cornell_boxes, "), HasSubstr("light_point, ")));
}

/// A name that would clear the screen and write a line of its own.
TEST_F(SceneFiles, NamesInThemGiveATerminalNoOrders) {
    const std::string evil = "&#27;[2J&#10;error: all is lost";
    const std::string scene = folder.write(
        "a.dae",
        floorScene(kAway + "<node><instance_light url=\"#" + evil + "\"/></node>") + "<!-- -->");
    const ProgramRun run = render(scene);
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr("\\x1b[2J\\nerror: all is lost"), Not(HasSubstr("\x1b")),
                               Not(HasSubstr("\nerror:"))));
    EXPECT_THAT(stromboli({"info", scene}).out, Not(HasSubstr("\x1b")));
}

TEST_F(SceneFiles, WithoutAnEndAreRefusedAtOnce) {
    ASSERT_EQ(mkfifo(folder.file("pipe.dae").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", folder.path() / "zero.dae");
    std::filesystem::create_symlink("/proc/self/mem", folder.path() / "memory.dae");
    const double before = cpuSeconds();
    for (const char* name : {"pipe.dae", "zero.dae", "memory.dae"}) {
        const ProgramRun run = render(folder.file(name));
        EXPECT_EQ(run.exitCode, kScene) << name;
        EXPECT_THAT(run.err, HasSubstr(name));
    }
    EXPECT_EQ(render("/dev/zero").exitCode, kScene);
    EXPECT_LT(cpuSeconds() - before, 20);
}

/// A Mitsuba scene says how large its picture is and how far light goes; options come first.
TEST_F(SceneFiles, HintsHoldWhereNoOptionSaysOtherwise) {
    const std::string scene = folder.write(
        "a.xml", "<scene version=\"3.0.0\"><default name=\"depth\" value=\"2\"/>"
                 "<integrator type=\"path\"><integer name=\"max_depth\" value=\"$depth\"/>"
                 "</integrator><sensor type=\"perspective\"><film type=\"hdrfilm\">"
                 "<integer name=\"width\" value=\"6\"/><integer name=\"height\" value=\"4\"/>"
                 "<rfilter type=\"box\"/></film></sensor><emitter type=\"constant\"/></scene>");
    const auto said = [&](std::vector<std::string> extra) {
        std::vector<std::string> words = {"render", scene, "-o", folder.file("a.exr"), "-s", "1"};
        words.insert(words.end(), extra.begin(), extra.end());
        return stromboli(words).err;
    };
    EXPECT_THAT(said({}), HasSubstr("the scene file asks for -m 1, --filter box, -r 6 4"));
    EXPECT_EQ(readExr(folder.file("a.exr")).width, 6u);
    EXPECT_THAT(said({"-D", "depth=4"}), HasSubstr("asks for -m 3"));
    EXPECT_THAT(said({"-m", "2", "--filter", "gaussian", "-r", "3", "3"}),
                Not(HasSubstr("the scene file asks for")));
    const ProgramRun wrong = stromboli({"info", scene, "-D", "other=4"});
    EXPECT_EQ(wrong.exitCode, kScene);
    EXPECT_THAT(wrong.err, HasSubstr("nothing in the scene refers to $other"));
}

/// Numbers of a filter belong to the file's own; so does what a sample is.
TEST_F(SceneFiles, HintsOfFiltersAndIntegrators) {
    const auto said = [&](const std::string& integrator, const std::string& filter,
                          std::vector<std::string> extra = {}) {
        const std::string scene = folder.write(
            "a.xml", "<scene version=\"3.0.0\"><integrator type=\"" + integrator +
                         "</integrator><sensor type=\"perspective\"><film type=\"hdrfilm\">"
                         "<integer name=\"width\" value=\"6\"/>"
                         "<integer name=\"height\" value=\"4\"/><rfilter type=\"" +
                         filter + "</rfilter></film></sensor><emitter type=\"constant\"/></scene>");
        std::vector<std::string> words = {"render", scene, "-o", folder.file("a.exr"), "-s", "1"};
        words.insert(words.end(), extra.begin(), extra.end());
        return stromboli(words).err;
    };
    EXPECT_THAT(said("path\"><integer name=\"rr_depth\" value=\"7\"/>",
                     "mitchell\"><float name=\"C\" value=\"0.5\"/>"),
                HasSubstr("roulette from bounce 7 on, --filter mitchell (B 0.333333, C 0.5), -r"));
    EXPECT_THAT(said("path\">", "gaussian\"><float name=\"stddev\" value=\"1\"/>"),
                HasSubstr("--filter gaussian (2 times as wide)"));
    EXPECT_THAT(said("path\">", "lanczos\"><integer name=\"lobes\" value=\"2\"/>"),
                HasSubstr("--filter lanczos (2 lobes)"));
    EXPECT_THAT(said("depth\">", "box\">"), HasSubstr("asks for --integrator depth"));
    EXPECT_THAT(said("depth\">", "box\">", {"--integrator", "path"}),
                Not(HasSubstr("--integrator depth")));
}

} // namespace
} // namespace stromboli::test
