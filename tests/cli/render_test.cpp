// The program as its users run it.
#include "host/film/image_formats.hpp"
#include "tests/cli/running_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Program : public testing::Test {
  protected:
    ScratchFolder folder;
    std::string scene = libraryScene("cornell_boxes.dae");

    ProgramRun render(const std::string& output, std::vector<std::string> extra) {
        std::vector<std::string> arguments = {"render", scene, "-o", folder.file(output),
                                              "-r",     "32",  "24"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        ProgramRun run = stromboli(arguments);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return run;
    }
};

TEST_F(Program, WritesPngAndReportsTheWork) {
    const ProgramRun run = render("a.png", {"-s", "4"});
    const ByteImage image = readPng(folder.file("a.png"));
    EXPECT_EQ(image.width, 32u);
    EXPECT_EQ(image.height, 24u);
    EXPECT_THAT(run.err, HasSubstr("3072 paths"));
    EXPECT_THAT(run.err, HasSubstr("Mrays/s"));
    EXPECT_THAT(run.err, HasSubstr("0 rejected"));
    EXPECT_THAT(run.err, Not(HasSubstr("\r"))); // no progress bar in a pipe
    EXPECT_EQ(run.out, "");
}

TEST_F(Program, LavapipeHasTheProcessorsLanes) {
    const std::string narrow = stromboli({"devices"}, "LP_NATIVE_VECTOR_WIDTH=128").out;
    if (narrow.find("llvmpipe") == std::string::npos) GTEST_SKIP() << "no lavapipe";
    EXPECT_THAT(narrow, HasSubstr("subgroup: 4 lanes")) << "what the user asks for";
#if defined(__x86_64__)
    // What other versions take by themselves is what they can do.
    if (__builtin_cpu_supports("avx512vl") && narrow.find("Mesa 22.3") != std::string::npos) {
        EXPECT_THAT(stromboli({"devices"}, "env -u LP_NATIVE_VECTOR_WIDTH").out,
                    HasSubstr("subgroup: 16 lanes"));
    }
#endif
}

TEST_F(Program, VectorsTooWideForLavapipeAreRefused) {
    const std::string wide = "LP_NATIVE_VECTOR_WIDTH=1024";
    if (stromboli({"devices"}).out.find("llvmpipe") == std::string::npos)
        GTEST_SKIP() << "no lavapipe";
    const ProgramRun run =
        stromboli({"render", scene, "-o", folder.file("a.png"), "--device", "cpu"}, wide);
    EXPECT_EQ(run.exitCode, 3);
    EXPECT_THAT(run.err, HasSubstr("LP_NATIVE_VECTOR_WIDTH"));
    EXPECT_TRUE(folder.entries().empty());
}

TEST_F(Program, TheWidthOfVectorsDoesNotShow) {
    render("own.exr", {"-s", "9", "--notes", "off"}); // they name the device with its width
    const std::string own = bytesOf(folder.path() / "own.exr");
    ASSERT_FALSE(own.empty());
    for (const char* bits : {"128", "256", "512"}) {
        const std::string environment = std::string("LP_NATIVE_VECTOR_WIDTH=") + bits;
        const ProgramRun run =
            stromboli({"render", scene, "-o", folder.file(bits + std::string(".exr")), "-r", "32",
                       "24", "-s", "9", "--notes", "off"},
                      environment);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_TRUE(bytesOf(folder.path() / (bits + std::string(".exr"))) == own) << bits;
    }
}

TEST_F(Program, ShowsProgressOnATerminal) {
    // script (bsdutils, on every Debian) gives the program a terminal of its own.
    const std::string command = "script -qec '" STROMBOLI_PROGRAM " render " + scene + " -o " +
                                folder.file("a.png") + " -r 32 24 -s 4096' /dev/null </dev/null >" +
                                folder.file("terminal");
    ASSERT_EQ(std::system(command.c_str()), 0);
    const std::string shown = bytesOf(folder.path() / "terminal");
    for (const char* part : {"\r", " %", "M samples", "Mrays/s", "left"})
        EXPECT_THAT(shown, HasSubstr(part));
}

TEST_F(Program, SaysHowFarItIsInLinesWhereThatIsAskedFor) {
    const ProgramRun lines = render("a.png", {"-s", "64", "--progress", "1ms"});
    EXPECT_THAT(lines.err, testing::ContainsRegex("info: +[0-9.]+ %, [0-9.]+ M samples in "));
    const ProgramRun objects = render("b.png", {"-s", "64", "--progress", "json"});
    std::istringstream all(objects.err);
    uint64_t samples = 0;
    for (std::string line; std::getline(all, line);) {
        if (!line.starts_with("{")) continue;
        const auto object = nlohmann::json::parse(line);
        EXPECT_GE(object["samples"].get<uint64_t>(), samples);
        samples = object["samples"].get<uint64_t>();
        EXPECT_TRUE(object["secondsLeft"].is_null() || object["secondsLeft"].is_number());
    }
    EXPECT_GT(samples, 0u);
    EXPECT_EQ(bytesOf(folder.path() / "a.png"), bytesOf(folder.path() / "b.png"));
    EXPECT_EQ(render("c.png", {"--progress", "off"}).exitCode, 0);
    EXPECT_EQ(stromboli({"render", scene, "-o", "d.png", "--progress", "often"}).exitCode, kUsage);
}

TEST_F(Program, StopsAtTheNoiseAskedForAndSaysSo) {
    const ProgramRun run = render("a.png", {"--noise", "0.2", "--stats", folder.file("s.json")});
    EXPECT_THAT(run.err, HasSubstr("; at most 20 % was asked for"));
    const auto json = nlohmann::json::parse(std::ifstream(folder.path() / "s.json"));
    EXPECT_LE(json["noiseRange"][1].get<double>(), 0.2);
    EXPECT_EQ(json["worstPixels"].get<uint64_t>(), 7u) << "a hundredth of 768";
    EXPECT_GT(json["noiseOfWorstPixels"].get<double>(), 0);
    EXPECT_LT(json["noiseOfWorstPixels"].get<double>(), 1);
    EXPECT_GT(json["noise"].get<double>(), 0.05);
    EXPECT_GE(json["samplesTaken"].get<uint64_t>(), 16u * 32 * 24);
    EXPECT_EQ(readPng(folder.file("a_rate.png")).width, 32u); // where the samples went
}

TEST_F(Program, SaysWhatNoiseItReachedWhenSomethingElseEndedIt) {
    EXPECT_THAT(render("a.png", {"--noise", "0.001", "-s", "16"}).err,
                HasSubstr("at most 0.10 % was asked for, but --time or -s ended the render"));
    const ProgramRun timed = render("b.png", {"--time", "1"});
    EXPECT_THAT(timed.err, HasSubstr("noise about"));
    EXPECT_THAT(timed.err, Not(HasSubstr("interrupted")));
}

/// A hundredth of a second is not enough for six million paths on any machine that this runs on.
TEST_F(Program, SaysWhichPixelsTimeDidNotReach) {
    const ProgramRun run =
        stromboli({"render", scene, "-o", folder.file("a.exr"), "-r", "1600", "1200", "--time",
                   "0.01", "--aov", "--stats", folder.file("s.json")});
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_THAT(run.err, HasSubstr("pixels have no sample (--time is too short for more)"));
    EXPECT_THAT(run.err, HasSubstr("noise unknown"));
    const auto json = nlohmann::json::parse(std::ifstream(folder.path() / "s.json"));
    EXPECT_FALSE(json["complete"].get<bool>());
    EXPECT_TRUE(json["noise"].is_null());
    const FloatImage picture = readExr(folder.file("a.exr"));
    const std::vector<float>& samples = picture.channels.at("samples");
    const auto unreached = std::count(samples.begin(), samples.end(), 0.0f);
    EXPECT_EQ(json["pixelsWithoutSamples"].get<int64_t>(), unreached);
    EXPECT_LT(unreached, 1600 * 1200);
    EXPECT_GT(unreached, 0);
}

TEST_F(Program, APictureInBandsHasTheSameBytes) {
    for (const char* kind : {".exr", ".png"}) {
        const std::string whole = std::string("whole") + kind, bands = std::string("bands") + kind;
        // 120 x 90 pixels take some megabytes.
        const auto arguments = [&](const std::string& output) {
            return std::vector<std::string>{
                "render", scene, "-o", folder.file(output), "-r", "120", "90", "-s", "2", "--even"};
        };
        std::vector<std::string> inBands = arguments(bands);
        inBands.insert(inBands.end(), {"--film-memory", "1", "--stats", folder.file("s.json")});
        ASSERT_EQ(stromboli(arguments(whole)).exitCode, 0);
        const ProgramRun run = stromboli(inBands);
        EXPECT_EQ(run.exitCode, 0);
        EXPECT_THAT(run.err, testing::ContainsRegex("rendering [0-9]+ bands"));
        EXPECT_TRUE(bytesOf(folder.path() / whole) == bytesOf(folder.path() / bands)) << kind;
        const auto json = nlohmann::json::parse(std::ifstream(folder.path() / "s.json"));
        EXPECT_EQ(json["samplesTaken"], 120 * 90 * 2);
        EXPECT_TRUE(json["complete"]);
    }
}

TEST_F(Program, SaysThatAPictureIsBlackOrTooBright) {
    EXPECT_THAT(
        render("a.png", {"-s", "1", "-m", "0", "--camera", "file"}).err,
        AllOf(Not(HasSubstr("brighter than white")), HasSubstr("% of the pixels are black: ")));
    EXPECT_THAT(render("b.png", {"-s", "4", "--exposure", "20"}).err,
                HasSubstr("% of the pixels are brighter than white: --exposure "));
    EXPECT_THAT(render("c.png", {"-s", "4", "--exposure", "-40"}).err,
                HasSubstr("so dark that all of it is black in 8 bits: --exposure "));
    EXPECT_THAT(render("d.png", {"-s", "4", "-m", "0", "--crop", "0", "23", "1", "1"}).err,
                HasSubstr("the picture is black: no path met light (lights and emitting surfaces"));
}

TEST_F(Program, QuietSaysNothing) {
    EXPECT_EQ(render("a.png", {"-s", "1", "-q"}).err, "");
}

TEST_F(Program, SameArgumentsSameBytes) {
    render("a.png", {"-s", "8"});
    render("b.png", {"-s", "8"});
    render("c.png", {"-s", "8", "--seed", "1"});
    EXPECT_EQ(readPng(folder.file("a.png")).rgb, readPng(folder.file("b.png")).rgb);
    EXPECT_NE(readPng(folder.file("a.png")).rgb, readPng(folder.file("c.png")).rgb);
}

TEST_F(Program, SpreadsSamplesUnlessToldNotTo) {
    scene = libraryScene("light_spot.dae"); // much of it is dark
    render("a.exr", {"-s", "40", "--aov", "--stats", folder.file("a.json")});
    render("b.exr", {"-s", "40", "--aov"});
    render("even.exr", {"-s", "40", "--aov", "--even", "--stats", folder.file("even.json")});
    const std::vector<float> a = readExr(folder.file("a.exr")).channels.at("samples");
    EXPECT_EQ(a, readExr(folder.file("b.exr")).channels.at("samples"));
    EXPECT_LT(*std::min_element(a.begin(), a.end()), 40);
    EXPECT_GT(*std::max_element(a.begin(), a.end()), 40);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a_rate.png")); // nobody asked for it
    EXPECT_EQ(readExr(folder.file("even.exr")).channels.at("samples"),
              std::vector<float>(32 * 24, 40.0f));
    const auto read = [&](const char* name) {
        return nlohmann::json::parse(std::ifstream(folder.path() / name));
    };
    EXPECT_EQ(read("a.json")["spread"], "by noise");
    EXPECT_EQ(read("a.json")["samplesPerPixel"], 40);
    EXPECT_LE(read("a.json")["samplesTaken"], 40 * 32 * 24);
    EXPECT_EQ(read("even.json")["spread"], "even");
    EXPECT_EQ(read("even.json")["samplesTaken"], 40 * 32 * 24);
}

TEST_F(Program, SamplesHaveBranchesWhereThatPays) {
    const auto statistics = [&](std::vector<std::string> words) {
        words.insert(words.end(), {"--even", "--aov", "--stats", folder.file("s.json")});
        render("a.exr", words);
        auto json = nlohmann::json::parse(std::ifstream(folder.file("s.json")));
        EXPECT_EQ(readExr(folder.file("a.exr")).channels.at("samples"), // of paths, all of them
                  std::vector<float>(32 * 24, json["samplesPerPixel"].get<float>()));
        return json;
    };
    const auto split = statistics({"-s", "64"}),
               whole = statistics({"-s", "64", "--branches", "1"});
    EXPECT_EQ(split["branches"], 4);
    EXPECT_EQ(whole["branches"], 1);
    EXPECT_EQ(split["samplesTaken"], whole["samplesTaken"]);
    EXPECT_LT(split["rays"].get<double>(), 0.8 * whole["rays"].get<double>());
    EXPECT_EQ(statistics({"-s", "63"})["branches"], 1); // as many as asked for
    EXPECT_EQ(statistics({"-s", "16"})["branches"], 2);
    EXPECT_EQ(statistics({"-s", "64", "-m", "1"})["branches"], 1);
    EXPECT_EQ(statistics({"-s", "60", "--branches", "3"})["samplesTaken"], 60 * 32 * 24);
}

TEST_F(Program, BranchesThatCannotBe) {
    for (const auto& [words, message] :
         {std::pair(std::vector<std::string>{"-s", "10", "--branches", "4"},
                    "-s 10 is not a multiple of --branches 4"),
          {{"-s", "64", "--branches", "65"}, "--branches"},
          {{"-s", "64", "-a", "16", "0.1", "--branches", "4"}, "--branches does not go with -a"},
          {{"--cs184", "-s", "4", "--branches", "4"}, "--branches does not go with -a"}}) {
        std::vector<std::string> all = {"render", scene, "-o", folder.file("no.png")};
        all.insert(all.end(), words.begin(), words.end());
        const ProgramRun run = stromboli(all);
        EXPECT_EQ(run.exitCode, 1);
        EXPECT_THAT(run.err, HasSubstr(message));
    }
}

TEST_F(Program, CheckAgreesOnBranches) {
    const ProgramRun run = stromboli(
        {"check", scene, "-r", "48", "36", "-s", "128", "--branches", "4", "--alpha", "1e-6"});
    EXPECT_EQ(run.exitCode, 0) << run.out << run.err;
}

TEST_F(Program, AnEvenCropHasTheBytesOfTheWhole) {
    render("whole.exr", {"-s", "20", "--even"});
    render("part.exr", {"-s", "20", "--even", "--crop", "9", "5", "12", "10"});
    const std::vector<float> whole = readExr(folder.file("whole.exr")).channels.at("G");
    const std::vector<float> part = readExr(folder.file("part.exr")).channels.at("G");
    ASSERT_EQ(part.size(), 120u);
    for (size_t i = 0; i < part.size(); ++i)
        EXPECT_EQ(part[i], whole[(5 + i / 12) * 32 + 9 + i % 12]);
}

TEST_F(Program, ExrHoldsWhatThePngShows) {
    render("a.exr", {"-s", "16", "--even", "--aov"});
    render("a.png", {"-s", "16", "--even", "--exposure", "1"});
    const FloatImage linear = readExr(folder.file("a.exr"));
    const ByteImage bytes = readPng(folder.file("a.png"));
    for (size_t i = 0; i < linear.channels.at("G").size(); ++i) {
        const double l = std::min(1.0, 2.0 * double(linear.channels.at("G")[i]));
        const double s = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
        EXPECT_NEAR(bytes.rgb[3 * i + 1], 255 * s, 0.51);
        EXPECT_EQ(linear.channels.at("samples")[i], 16.0f);
    }
}

TEST_F(Program, AdaptiveWritesARatePicture) {
    render("a.png", {"-s", "256", "-a", "16", "0.2"});
    EXPECT_EQ(readPng(folder.file("a_rate.png")).width, 32u);
}

TEST_F(Program, StatisticsAreJson) {
    render("a.png", {"-s", "2", "--stats", folder.file("s.json")});
    const auto json = nlohmann::json::parse(std::ifstream(folder.path() / "s.json"));
    EXPECT_EQ(json["samplesTaken"], 32 * 24 * 2);
    EXPECT_EQ(json["paths"], 32 * 24 * 2);
    EXPECT_TRUE(json["complete"]);
    EXPECT_GT(json["rays"], json["paths"]);
}

TEST_F(Program, ReferenceBackend) {
    render("a.png", {"-s", "1", "--backend", "reference"});
    EXPECT_EQ(readPng(folder.file("a.png")).width, 32u);
}

TEST_F(Program, CheckAgrees) {
    const ProgramRun run =
        stromboli({"check", scene, "-r", "48", "36", "-s", "64", "--alpha", "1e-6"});
    EXPECT_EQ(run.exitCode, 0) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr("agree"));
}

TEST_F(Program, CheckOfOneSampleDecidesNothing) {
    const ProgramRun run =
        stromboli({"check", scene, "-r", "16", "12", "-s", "1", "--alpha", "1e-6"});
    EXPECT_EQ(run.exitCode, 6) << run.out << run.err;
    EXPECT_THAT(run.out, AllOf(HasSubstr("verdict: UNDECIDED"), HasSubstr("sight      unknown")));
    EXPECT_THAT(run.out, Not(HasSubstr("agree")));
}

TEST_F(Program, InfoNamesWhatTheKernelHolds) {
    const ProgramRun run = stromboli({"info", libraryScene("cornell_mirror_glass.dae")});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    for (const char* part :
         {"mirror", "glass", "records on a line", "primitive buffer", "film", "leaves"})
        EXPECT_THAT(run.out, HasSubstr(part));
    EXPECT_THAT(run.out, Not(HasSubstr("microfacet")));
}

TEST_F(Program, DevicesNamesTheChosenOne) {
    const ProgramRun run = stromboli({"devices"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("chosen"));
    EXPECT_THAT(run.out, HasSubstr("usable"));
}

TEST_F(Program, HelpAndVersion) {
    const ProgramRun help = stromboli({"render", "--help"});
    EXPECT_EQ(help.exitCode, 0);
    for (const char* part : {"--samples", "--roulette", "[64", "Sampling", "Output", "Device"})
        EXPECT_THAT(help.out, HasSubstr(part));
    const ProgramRun version = stromboli({"--version"});
    EXPECT_EQ(version.exitCode, 0);
    EXPECT_THAT(version.out, HasSubstr("stromboli"));
}

TEST_F(Program, InterruptWritesWhatThereIs) {
    const std::string output = folder.file("a.png");
    RunningProgram program({"render", scene, "-o", output, "-r", "32", "24", "-s", "10000000"},
                           {80}, {"STROMBOLI_VALIDATION=1"});
    ASSERT_TRUE(program.says("M samples", 250)); // as long as a busy machine may take
    program.send(SIGINT);
    const ProgramRun run = program.finish(250);
    EXPECT_EQ(run.exitCode, 130) << run.err;
    EXPECT_THAT(run.err, HasSubstr("interrupted"));
    EXPECT_EQ(readPng(output).width, 32u);
}

} // namespace
} // namespace stromboli::test
