#include "host/film/image_formats.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <fstream>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

std::string constantExr(const ScratchFolder& folder, const std::string& name, float value) {
    FloatImage image(8, 6);
    for (const char* channel : {"R", "G", "B"})
        image.channel(channel).assign(48, value);
    writeExr(folder.file(name), image);
    return folder.file(name);
}

TEST(CompareCommand, LimitsDecideTheExitCode) {
    const ScratchFolder folder;
    const std::string a = constantExr(folder, "a.exr", 1), b = constantExr(folder, "b.exr", 1.1f);
    const ProgramRun plain = stromboli({"compare", a, b});
    EXPECT_EQ(plain.exitCode, 0) << plain.err;
    EXPECT_THAT(plain.out, HasSubstr("relMSE      0.00990")); // 0.1^2 / 1.01
    EXPECT_EQ(stromboli({"compare", a, b, "--max-relmse", "0.01", "--max-bias", "11"}).exitCode, 0);
    const ProgramRun broken = stromboli({"compare", a, b, "--max-relmse", "0.009"});
    EXPECT_EQ(broken.exitCode, 3);
    EXPECT_THAT(broken.err, HasSubstr("relMSE is 0.00990"));
}

TEST(CompareCommand, WritesJsonAndDifferences) {
    const ScratchFolder folder;
    const std::string a = constantExr(folder, "a.exr", 1), b = constantExr(folder, "b.exr", 1.5f);
    const ProgramRun run =
        stromboli({"compare", a, b, "--json", "-", "--diff", folder.file("d.exr")});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const nlohmann::json json = nlohmann::json::parse(run.out);
    EXPECT_DOUBLE_EQ(json["mse"].get<double>(), 0.25);
    EXPECT_TRUE(json["violations"].empty());
    EXPECT_EQ(readExr(folder.file("d.exr")).channels.at("G")[7], 0.5f);
    for (const char* what : {"flip", "relative", "signed"}) {
        EXPECT_EQ(stromboli({"compare", a, b, "--diff", folder.file("d.png"), "--show", what,
                             "--json", folder.file("d.json")})
                      .exitCode,
                  0);
        EXPECT_EQ(readPng(folder.file("d.png")).width, 8u);
    }
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(folder.file("d.json")))["width"], 8);
}

TEST(CompareCommand, AnErrorRateOfTestsThatAreNotMadeIsSaid) {
    const ScratchFolder folder;
    const std::string plain = constantExr(folder, "a.exr", 1);
    const auto aov = [&](const std::string& name) {
        EXPECT_EQ(stromboli({"render", libraryScene("cornell_boxes.dae"), "-o", folder.file(name),
                             "-r", "8", "6", "-s", "8", "--branches", "4", "--aov"})
                      .exitCode,
                  0);
        return folder.file(name);
    };
    const std::string full = aov("b.exr");
    const ProgramRun run = stromboli({"compare", full, plain, "--alpha", "0.1"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr(plain + " has no variances"));
    EXPECT_THAT(run.err, HasSubstr("ignored: --alpha"));
    EXPECT_EQ(stromboli({"compare", full, full, "--alpha", "0.1"}).err, "");
    EXPECT_EQ(stromboli({"compare", plain, plain}).err, "");
}

/// Four paths that share a camera ray are one sample, of which no variance is known.
TEST(CompareCommand, PathsThatShareASampleAreNoSamples) {
    const ScratchFolder folder;
    const auto render = [&](const std::string& name, const std::string& seed,
                            const std::string& paths) {
        EXPECT_EQ(
            stromboli({"render", libraryScene("cornell_boxes.dae"), "-o", folder.file(name), "-r",
                       "16", "12", "-s", paths, "--branches", "4", "--aov", "--seed", seed})
                .exitCode,
            0);
        return folder.file(name);
    };
    const ProgramRun one =
        stromboli({"compare", render("a.exr", "1", "4"), render("b.exr", "2", "4")});
    EXPECT_THAT(one.out, HasSubstr("UNDECIDED: no pixel has two samples"));
    EXPECT_THAT(one.out, HasSubstr("4 paths share each sample (--branches)"));
    const ProgramRun many =
        stromboli({"compare", render("c.exr", "1", "64"), render("d.exr", "2", "64"), "--ztest"});
    EXPECT_EQ(many.exitCode, 0) << many.out;
    EXPECT_THAT(many.out, HasSubstr("the pictures agree"));
}

/// A variance of 0.04 and 400 samples: differences of 0.01 are one standard deviation.
TEST(CompareCommand, VarianceOfTheReferenceDecidesTheExitCode) {
    const ScratchFolder folder;
    const std::string a = constantExr(folder, "a.exr", 1), v = constantExr(folder, "v.exr", 0.04f);
    const std::string near = constantExr(folder, "near.exr", 1.01f);
    const std::string far = constantExr(folder, "far.exr", 1.1f);
    const ProgramRun accepted =
        stromboli({"compare", a, near, "--ztest-variance", v, "-s", "400", "--json", "-"});
    EXPECT_EQ(accepted.exitCode, 0) << accepted.err;
    const nlohmann::json json = nlohmann::json::parse(accepted.out)["acceptance"];
    EXPECT_EQ(json["accepted"], true);
    EXPECT_EQ(json["share"], 1.0);
    const ProgramRun refused = stromboli({"compare", a, far, "--ztest-variance", v, "-s", "400"});
    EXPECT_EQ(refused.exitCode, 3);
    EXPECT_THAT(refused.out, HasSubstr("NOT ACCEPTED"));
    const ProgramRun unknown = stromboli({"compare", a, far, "--ztest-variance", v});
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_THAT(unknown.err, HasSubstr("needs -s N"));
}

TEST(CompareCommand, AMisspelledFileIsAnsweredByTheOneThatWasMeant) {
    const ScratchFolder folder;
    const std::string right = constantExr(folder, "reference.exr", 1);
    for (const std::string command : {"compare", "tonemap"}) {
        std::vector<std::string> words{command, folder.file("refrence.exr")};
        const std::vector<std::string> rest =
            command == "compare" ? std::vector{right}
                                 : std::vector<std::string>{"-o", folder.file("a.png")};
        words.insert(words.end(), rest.begin(), rest.end());
        EXPECT_THAT(stromboli(words).err, HasSubstr("did you mean " + right + "?")) << command;
    }
    EXPECT_THAT(stromboli({"compare", right, folder.file("nothing.exr")}).err,
                HasSubstr("nothing.exr: there is no such file\n"));
}

TEST(CompareCommand, BadInputIsOneLine) {
    const ScratchFolder folder;
    const std::string a = constantExr(folder, "a.exr", 1);
    const std::vector<std::vector<std::string>> bad = {
        {"compare", a},
        {"compare", a, folder.file("none.exr")},
        {"compare", a, folder.write("b.txt", "x")},
        {"compare", a, a, "--diff", a},
        {"compare", a, a, "--ztest"},
        {"compare", a, a, "--show", "nothing"},
        {"compare", a, a, "--diff", folder.file("d.jpg")}};
    for (const std::vector<std::string>& arguments : bad) {
        const ProgramRun run = stromboli(arguments);
        EXPECT_EQ(run.exitCode, 1) << arguments.back();
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
}

} // namespace
} // namespace stromboli::test
