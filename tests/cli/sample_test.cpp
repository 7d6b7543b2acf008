// One pixel or sample of a picture by itself: --pixel and --sample.
#include "host/film/image_formats.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

/// The three numbers after "radiance".
std::vector<std::string> radianceOf(const ProgramRun& run) {
    std::istringstream words(run.out);
    std::string word;
    std::vector<std::string> numbers;
    words >> word;
    EXPECT_EQ(word, "radiance") << run.out << run.err;
    for (int i = 0; i < 3 && words >> word; ++i)
        numbers.push_back(word);
    return numbers;
}

class Sample : public testing::Test {
  protected:
    ScratchFolder folder;
    std::string scene = libraryScene("cornell_metal.dae");

    ProgramRun renderWith(std::vector<std::string> extra) {
        std::vector<std::string> arguments = {"render", scene, "-r", "32", "24", "--seed", "5"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        return stromboli(arguments);
    }
};

/// All samples of a picture of one sample a pixel, from its EXR; no digit is lost.
TEST_F(Sample, PrintsWhatThePictureHolds) {
    for (const std::string backend : {"vulkan", "reference"}) {
        // One sample: of one path, and of four.
        for (const std::string paths : {"1", "4"}) {
            const std::string picture = folder.file(backend + ".exr");
            const std::vector<std::string> common = {"-s",  paths,       "--branches",
                                                     paths, "--backend", backend};
            std::vector<std::string> words = common;
            words.insert(words.end(), {"-o", picture});
            ASSERT_EQ(renderWith(words).exitCode, 0);
            const FloatImage image = readExr(picture);
            words = common;
            words.insert(words.end(), {"--pixel", "13", "17", "--sample", "0"});
            const ProgramRun run = renderWith(words);
            EXPECT_EQ(run.exitCode, 0);
            EXPECT_THAT(run.out, HasSubstr("accepted"));
            const std::vector<std::string> radiance = radianceOf(run);
            ASSERT_EQ(radiance.size(), 3u);
            const char* const channels[] = {"R", "G", "B"};
            for (int c = 0; c < 3; ++c) {
                const float inPicture = image.channels.at(channels[c])[17 * 32 + 13];
                EXPECT_GT(inPicture, 0);
                EXPECT_EQ(float(std::stod(radiance[c])), inPicture)
                    << backend << ' ' << channels[c];
            }
        }
    }
}

TEST_F(Sample, DependsOnItsNumberPixelAndSeed) {
    const std::vector<std::string> name = {"--pixel", "13", "17", "--sample", "3"};
    const ProgramRun run = renderWith(name);
    EXPECT_EQ(renderWith(name).out, run.out);
    for (std::vector<std::string> other :
         {std::vector<std::string>{"--pixel", "13", "17", "--sample", "4"},
          {"--pixel", "12", "17", "--sample", "3"},
          {"--pixel", "13", "17", "--sample", "3", "--seed", "6"}})
        EXPECT_NE(renderWith(other).out, run.out) << testing::PrintToString(other);
}

/// As a command gets them that is run again: what only concerns pictures is of no effect, but for
/// the branches of a sample, if it chooses them.
TEST_F(Sample, WritesNoFile) {
    const std::vector<std::string> name = {"--pixel", "13",         "17", "--sample",
                                           "3",       "--branches", "1"};
    std::vector<std::string> all = {
        "-o",      folder.file("a.png"),  "-s",     "2", "-a", "32", "0.1",
        "--stats", folder.file("s.json"), "--crop", "1", "1",  "2",  "2"};
    all.insert(all.end(), name.begin(), name.end());
    const ProgramRun run = renderWith(all);
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(run.out, renderWith(name).out);
    EXPECT_TRUE(folder.entries().empty());
}

/// A triangle of the given emission that fills half of the view.
std::string emitterOf(const std::string& emission) {
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><emission><color>)" +
           emission + R"( 1</color></emission></lambert></technique></profile_COMMON></effect>
</library_effects><library_materials><material id="m"><instance_effect url="#e"/></material>
</library_materials><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#f" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>
</triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="m" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

/// The words after "add" in a line on rejected samples, up to "to".
std::vector<std::string> optionsToAdd(const std::string& line) {
    const std::string before = "add ";
    const size_t add = line.find(before + "--pixel");
    const size_t to = line.find(" to the", add);
    if (add == std::string::npos || to == std::string::npos) return {};
    std::istringstream words(line.substr(add + before.size(), to - add - before.size()));
    return {std::istream_iterator<std::string>(words), {}};
}

/// Radiance beyond what a film can add up (2^48), and the same below it: a run's own line is all
/// that is needed to see the sample that it left out.
TEST_F(Sample, ARejectedOneIsFoundByTheLineThatReportsIt) {
    scene = folder.write("bright.dae", emitterOf("1e20 2 3"));
    const std::vector<std::string> command = {"-o", folder.file("a.png"), "-s", "8"};
    const ProgramRun run = renderWith(command);
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("left out"));
    const std::vector<std::string> name = optionsToAdd(run.err);
    ASSERT_EQ(name.size(), 5u) << run.err;
    std::vector<std::string> again = command;
    again.insert(again.end(), name.begin(), name.end());
    const ProgramRun alone = renderWith(again);
    EXPECT_EQ(alone.exitCode, 0) << alone.err;
    EXPECT_THAT(alone.out, HasSubstr("rejected: too large"));
    EXPECT_THAT(radianceOf(alone), testing::ElementsAre("1.00000002e+20", "2", "3"));

    scene = folder.write("dim.dae", emitterOf("1e14 2 3"));
    EXPECT_THAT(renderWith(command).err, testing::Not(HasSubstr("left out")));
    EXPECT_THAT(renderWith(again).out, HasSubstr("accepted"));
}

TEST_F(Sample, WrongNamesAreRefused) {
    const auto expectRefused = [&](std::vector<std::string> extra, const char* message) {
        const ProgramRun run = renderWith(std::move(extra));
        EXPECT_EQ(run.exitCode, 1) << run.err;
        EXPECT_THAT(run.err, HasSubstr(message));
        EXPECT_EQ(run.out, "");
    };
    expectRefused({"--pixel", "32", "0", "--sample", "0"}, "32 x 24");
    expectRefused({"--pixel", "0", "24", "--sample", "0"}, "32 x 24");
    expectRefused({"--pixel", "-1", "3", "--sample", "0"}, "--pixel");
    expectRefused({"--pixel", "3", "--sample", "0"}, "--pixel");
    expectRefused({"--sample", "4"}, "--pixel");
    expectRefused({"--pixel", "3", "4", "--sample", "20000000"}, "--sample");
    expectRefused({"--pixel", "3", "4", "--sample", "x"}, "--sample");
    expectRefused({"--json", "a.json"}, "--pixel");
    expectRefused({}, "--output is required");
}

/// Kernel and reference of one path, as JSON: vertices that add up to the sample.
TEST_F(Sample, ExplainsItsPath) {
    const std::vector<std::string> words = {"--pixel", "13", "17", "--sample", "3", "-s", "1"};
    std::vector<std::string> asJson = words;
    asJson.insert(asJson.end(), {"--json", "-"});
    const ProgramRun run = renderWith(asJson);
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["sample"], 3);
    EXPECT_EQ(json["pixel"], nlohmann::json({13, 17}));
    const auto& kernel = json["kernel"];
    EXPECT_EQ(kernel["verdict"], "accepted");
    double sum = 0;
    for (const auto& vertex : kernel["vertices"]) {
        sum += vertex["radiance"][0].get<double>();
        for (const auto& light : vertex["lights"])
            sum += light["radiance"][0].get<double>();
    }
    const double radiance = kernel["radiance"][0];
    EXPECT_GT(radiance, 0);
    EXPECT_NEAR(sum, radiance, 1e-5 * radiance);
    EXPECT_NEAR(json["reference"]["radiance"][0].get<double>(), radiance, 1e-3 * radiance);
    EXPECT_EQ(json["reference"]["vertices"].size(), kernel["vertices"].size());
    EXPECT_EQ(kernel["vertices"][0]["object"], json["reference"]["vertices"][0]["object"]);
    EXPECT_NE(kernel["vertices"][0]["material"], "");

    const ProgramRun text = renderWith(words);
    EXPECT_THAT(text.out, HasSubstr("the same path by the reference"));
    EXPECT_THAT(text.out, HasSubstr("light sample: "));
    EXPECT_THAT(text.out, HasSubstr("bounce: "));
    EXPECT_THAT(text.out, HasSubstr(kernel["vertices"][0]["object"].get<std::string>()));
}

/// Its mean is that of the picture in which every pixel has as many samples.
TEST_F(Sample, ExplainsItsPixel) {
    const std::string picture = folder.file("a.exr");
    ASSERT_EQ(renderWith({"-s", "16", "--branches", "1", "--even", "-o", picture}).exitCode, 0);
    const FloatImage image = readExr(picture);
    const std::vector<std::string> words = {"-s", "16", "--branches", "1", "--pixel", "13", "17"};
    std::vector<std::string> asJson = words;
    asJson.insert(asJson.end(), {"--json", "-"});
    const ProgramRun run = renderWith(asJson);
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["kernel"]["samples"], 16);
    EXPECT_EQ(json["reference"]["samples"], 16);
    const double inPicture = double(image.channels.at("R")[17 * 32 + 13]);
    EXPECT_NEAR(json["kernel"]["mean"][0].get<double>(), inPicture, 1e-6 * inPicture);
    // Independent pictures: five standard errors are a false alarm once in a million pixels.
    EXPECT_LT(json["standard_errors_apart"].get<double>(), 5);
    const auto& heaviest = json["kernel"]["heaviest"];
    ASSERT_EQ(heaviest.size(), 8u);
    const auto luminance = [&](size_t i) {
        const auto& c = heaviest[i]["radiance"];
        return 0.2126 * c[0].get<double>() + 0.7152 * c[1].get<double>() +
               0.0722 * c[2].get<double>();
    };
    for (size_t i = 1; i < heaviest.size(); ++i)
        EXPECT_LE(luminance(i), luminance(i - 1) + 1e-6);
    const std::string number = std::to_string(heaviest[0]["sample"].get<int>());
    const ProgramRun one = renderWith(
        {"-s", "16", "--branches", "1", "--pixel", "13", "17", "--sample", number, "--json", "-"});
    EXPECT_EQ(nlohmann::json::parse(one.out)["kernel"]["radiance"], heaviest[0]["radiance"]);
    EXPECT_THAT(renderWith(words).out, HasSubstr("heaviest samples"));
}

/// Without Vulkan: paths of the reference's own.
TEST_F(Sample, IsExplainedByTheReferenceAlone) {
    const ProgramRun run = renderWith(
        {"--backend", "reference", "--pixel", "13", "17", "--sample", "0", "--json", "-"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_FALSE(json.contains("kernel"));
    EXPECT_GT(json["reference"]["vertices"].size(), 0u);
}

} // namespace
} // namespace stromboli::test
