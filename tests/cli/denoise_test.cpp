// Pictures without their noise, as users ask for them.
#include "host/film/image_formats.hpp"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;
using Json = nlohmann::json;

class DenoiseCli : public testing::Test {
  protected:
    ScratchFolder folder;

    /// A room of 40 x 30 pixels.
    ProgramRun render(std::vector<std::string> words) {
        std::vector<std::string> all = {"render", libraryScene("cornell_boxes.dae"), "-r", "40",
                                        "30"};
        all.insert(all.end(), words.begin(), words.end());
        return stromboli(all);
    }
    FloatImage rendered(const std::string& file, std::vector<std::string> words) {
        words.insert(words.end(), {"-o", folder.file(file), "--notes", "off"});
        const ProgramRun run = render(words);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return readExr(folder.file(file));
    }
    Json statistics(const std::string& file) {
        std::ifstream in(folder.file(file));
        return Json::parse(in);
    }
};

std::vector<std::string> namesOf(const FloatImage& image) {
    std::vector<std::string> names;
    for (const auto& channel : image.channels)
        names.push_back(channel.first);
    return names;
}

TEST_F(DenoiseCli, AnExrHasThePictureTheNoisyOneAndTheError) {
    const FloatImage noisy = rendered("noisy.exr", {"-s", "16"});
    FloatImage image =
        rendered("a.exr", {"-s", "16", "--denoise", "on", "--stats", folder.file("a.json")});
    EXPECT_THAT(namesOf(image), UnorderedElementsAre("R", "G", "B", "error.R", "error.G", "error.B",
                                                     "noisy.R", "noisy.G", "noisy.B"));
    for (const char* channel : {"R", "G", "B"}) {
        EXPECT_EQ(image.channel(std::string("noisy.") + channel), noisy.channels.at(channel));
        EXPECT_NE(image.channel(channel), noisy.channels.at(channel));
    }
    const Json said = statistics("a.json").at("denoised");
    EXPECT_GT(said.at("noise").get<double>(), 0);
    EXPECT_LT(said.at("noiseRange")[0].get<double>(), said.at("noise").get<double>());
    EXPECT_LT(said.at("noise").get<double>(), statistics("a.json").at("noise").get<double>());
}

TEST_F(DenoiseCli, TheErrorIsSaidAndLayersThatAreAskedForAreThere) {
    const ProgramRun run =
        render({"-s", "16", "--denoise", "on", "--layers", "normal", "-o", folder.file("a.exr")});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("denoised: error about "));
    const FloatImage image = readExr(folder.file("a.exr"));
    EXPECT_TRUE(image.channels.contains("normal.X"));
    EXPECT_FALSE(image.channels.contains("albedo.R"));
}

TEST_F(DenoiseCli, APictureInAFile) {
    const FloatImage noisy =
        rendered("in.exr", {"-s", "16", "--even", "--aov", "--layers", "albedo,normal,depth"});
    const ProgramRun run =
        stromboli({"denoise", folder.file("in.exr"), "-o", folder.file("out.exr")});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("denoised: error about "));
    const FloatImage out = readExr(folder.file("out.exr"));
    EXPECT_EQ(out.channels.at("noisy.R"), noisy.channels.at("R"));
    EXPECT_EQ(out.channels.at("albedo.R"), noisy.channels.at("albedo.R"));
    EXPECT_NE(out.channels.at("R"), noisy.channels.at("R"));
    EXPECT_EQ(stromboli({"denoise", folder.file("in.exr"), "-o", folder.file("out.png")}).exitCode,
              0);
}

TEST_F(DenoiseCli, AFileThatDoesNotSayHowNoisyItIsIsRefused) {
    rendered("in.exr", {"-s", "2"});
    const ProgramRun run =
        stromboli({"denoise", folder.file("in.exr"), "-o", folder.file("out.png")});
    EXPECT_EQ(run.exitCode, kUsage);
    EXPECT_THAT(run.err, HasSubstr("how noisy it is cannot be told"));
}

/// The error of the denoised picture is what --noise is the limit of.
TEST_F(DenoiseCli, NoiseStopsByTheDenoisedPicture) {
    const auto samplesTo = [&](const std::string& name, std::vector<std::string> more) {
        std::vector<std::string> words = {"render",
                                          libraryScene("cornell_boxes.dae"),
                                          "-r",
                                          "120",
                                          "90",
                                          "--noise",
                                          "0.15",
                                          "-o",
                                          folder.file(name + ".exr"),
                                          "--stats",
                                          folder.file(name + ".json")};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(stromboli(words).exitCode, 0);
        return statistics(name + ".json").at("samplesTaken").get<double>();
    };
    const double noisy = samplesTo("noisy", {}), denoised = samplesTo("clean", {"--denoise", "on"});
    EXPECT_LT(denoised, 0.5 * noisy);
    EXPECT_LE(statistics("clean.json").at("denoised").at("noiseRange")[1].get<double>(), 0.15);
}

TEST_F(DenoiseCli, WithoutOpenImageDenoiseThatIsSaid) {
    const ProgramRun run = render({"-s", "4", "--denoise", "oidn", "-o", folder.file("a.png")});
    if (run.exitCode == 0) GTEST_SKIP() << "it is installed";
    EXPECT_EQ(run.exitCode, kUsage);
    EXPECT_THAT(run.err, HasSubstr("Open Image Denoise 2 cannot be used"));
}

TEST_F(DenoiseCli, AFilmInBandsIsRefused) {
    const ProgramRun run =
        stromboli({"render", libraryScene("cornell_boxes.dae"), "-r", "1200", "1000", "-s", "1",
                   "--even", "--film-memory", "1", "--denoise", "on", "-o", folder.file("a.png")});
    EXPECT_EQ(run.exitCode, kUsage);
    EXPECT_THAT(run.err, HasSubstr("--film-memory"));
}

} // namespace
} // namespace stromboli::test
