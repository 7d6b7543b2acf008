// Pictures for a screen: their options in `render` and `merge`, and `tonemap`, which makes them
// later.
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "tests/cli/parse.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string refusal(const std::vector<std::string>& words) {
    return refusalOf([&] { parseAny(words); });
}

std::string renderRefusal(std::vector<std::string> words, const std::string& output = "a.png") {
    words.insert(words.begin(), {"render", "a.dae", "-o", output});
    return refusal(words);
}

std::string tonemapRefusal(std::vector<std::string> words, const std::string& output = "b.png") {
    words.insert(words.begin(), {"tonemap", "a.exr", "-o", output});
    return refusal(words);
}

// --- Options -------------------------------------------------------------------------------------

TEST(ToneOptions, AreUnderstood) {
    const auto o = parse({"render", "a.dae", "-o", "a.jpg", "--view", "agx", "--exposure", "auto",
                          "--white-balance", "3200", "--dither", "on", "--quality", "80"});
    EXPECT_EQ(o.tone.view, View::AgX);
    EXPECT_TRUE(o.tone.metersExposure);
    EXPECT_FALSE(o.tone.metersIlluminant);
    EXPECT_EQ(o.tone.illuminant, 3200);
    EXPECT_TRUE(o.output.encoding.dithers);
    EXPECT_EQ(o.output.encoding.quality, 80u);
    const auto t = parse<TonemapOptions>({"tonemap", "a.exr", "-o", "b.png", "--layer", "albedo",
                                          "--white-balance", "auto", "--bits", "16", "--view",
                                          "pbr-neutral", "--exposure", "-2"});
    EXPECT_EQ(t.layer, "albedo");
    EXPECT_TRUE(t.tone.metersIlluminant);
    EXPECT_EQ(t.tone.curve.exposure, -2);
    EXPECT_EQ(t.tone.view, View::PbrNeutral);
    EXPECT_EQ(t.output.encoding.bits, 16u);
}

/// Pictures of earlier versions keep their bytes.
TEST(ToneOptions, AreOffWhereTheyAreNotGiven) {
    const auto o = parse({"render", "a.dae", "-o", "a.png"});
    EXPECT_TRUE(o.tone.isCurveAlone());
    EXPECT_TRUE(o.output.encoding.isUsual());
    EXPECT_EQ(o.tone.curve.exposure, 0);
}

TEST(ToneOptions, WhatIsNoValueIsRefused) {
    EXPECT_EQ(renderRefusal({"--view", "aces"}),
              "--view is 'aces': expected standard, agx, filmic or pbr-neutral");
    EXPECT_EQ(renderRefusal({"--exposure", "automatic"}),
              "--exposure is 'automatic': expected auto or a number from -100 to 100");
    EXPECT_EQ(renderRefusal({"--white-balance", "999"}),
              "--white-balance is '999': expected auto or a number from 1000 to 25000");
    EXPECT_EQ(renderRefusal({"--bits", "12"}), "--bits is '12': expected 8 or 16");
    EXPECT_EQ(renderRefusal({"--quality", "0"}, "a.jpg"),
              "--quality is '0': expected a whole number from 1 to 100");
}

TEST(ToneOptions, WhatHasNoEffectIsRefused) {
    EXPECT_THAT(renderRefusal({"--view", "agx", "--dither", "on"}, "a.exr"),
                HasSubstr("--view, --dither is for pictures of a screen"));
    EXPECT_THAT(renderRefusal({"--bits", "16"}, "a.jpg"), HasSubstr("--bits 16 needs a PNG file"));
    EXPECT_EQ(renderRefusal({"--bits", "16"}, "-"), "");
    EXPECT_THAT(renderRefusal({"--bits", "16", "--dither", "on"}),
                HasSubstr("--dither on is for 8 bits"));
    EXPECT_THAT(renderRefusal({"--quality", "90"}), HasSubstr("--quality is for JPEG and WebP"));
    EXPECT_EQ(renderRefusal({"--quality", "90"}, "a.webp"), "");
    EXPECT_THAT(renderRefusal({"--view", "agx", "--cs184"}), HasSubstr("exclude each other"));
    EXPECT_THAT(renderRefusal({"--aov"}, "a.jpg"), HasSubstr("--aov needs an EXR file: a.jpg"));
    EXPECT_THAT(renderRefusal({"--layers", "albedo"}, "a.webp"), HasSubstr("needs an EXR file"));
    for (const char* option : {"--view=agx", "--white-balance=auto", "--bits=16", "--quality=90"})
        EXPECT_THAT(renderRefusal({"--share", "1/2", option}, "a.film"), HasSubstr("merge has it"));
}

TEST(ToneOptions, AJpegHasNoAlpha) {
    EXPECT_THAT(renderRefusal({"--transparent"}, "a.JPG"), HasSubstr("a JPEG, which has no alpha"));
    EXPECT_EQ(renderRefusal({"--transparent"}, "a.webp"), "");
}

TEST(ToneOptions, OfACommandThatMakesNoSuchPictureAreUnknown) {
    EXPECT_THAT(refusal({"check", "a.dae", "--view", "agx"}),
                HasSubstr("check has no option --view; it is one of render, view, tonemap, "
                          "denoise, submit, merge"));
    EXPECT_THAT(refusal({"compare", "a.exr", "b.exr", "--diff", "c.jpg"}),
                HasSubstr("expected a .png or an .exr file"));
}

TEST(TonemapOptions, OfWhatItCannotMakeAreRefused) {
    EXPECT_THAT(tonemapRefusal({}, "b.exr"), HasSubstr("tonemap makes pictures for a screen"));
    EXPECT_THAT(tonemapRefusal({}, "b.gif"), HasSubstr("unknown kind of picture"));
    EXPECT_THAT(refusal({"tonemap", "a.png", "-o", "a.png"}),
                HasSubstr("would replace the picture that is read"));
    EXPECT_EQ(tonemapRefusal({}), "");
}

// --- Pictures ------------------------------------------------------------------------------------

class Tonemap : public testing::Test {
  protected:
    ScratchFolder folder;
    std::string scene = libraryScene("cornell_boxes.dae");

    ProgramRun render(const std::string& output, const std::vector<std::string>& extra = {}) {
        std::vector<std::string> words = {
            "render", scene, "-o", folder.file(output), "-r", "32", "24", "-s", "8", "--even"};
        return run(std::move(words), extra);
    }
    ProgramRun tonemap(const std::string& input, const std::string& output,
                       const std::vector<std::string>& extra = {}) {
        return run({"tonemap", folder.file(input), "-o", folder.file(output)}, extra);
    }
    std::string bytesOf(const std::string& name) const {
        std::ifstream file(folder.path() / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::vector<uint8_t> pixels(const std::string& name) const {
        return readPng(folder.path() / name).rgb;
    }
    std::string note(const std::string& picture, const std::string& name) const {
        for (const PictureNote& note : readPictureNotes(folder.path() / picture))
            if (note.name == name) return note.text;
        return "none";
    }

  private:
    static ProgramRun run(std::vector<std::string> words, const std::vector<std::string>& extra) {
        words.insert(words.end(), extra.begin(), extra.end());
        ProgramRun result = stromboli(words);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return result;
    }
};

/// Pictures with one of the options that the plain one has not are made of the floats that an EXR
/// file holds.
TEST_F(Tonemap, MakesTheBytesOfARender) {
    render("a.exr");
    const std::vector<std::vector<std::string>> looks = {
        {"--view", "agx"},
        {"--view", "filmic", "--exposure", "1.5"},
        {"--view", "pbr-neutral", "--white-balance", "3000"},
        {"--exposure", "auto"},
        {"--white-balance", "auto", "--exposure", "auto", "--dither", "on"},
        {"--bits", "16"}};
    for (std::vector<std::string> look : looks) {
        look.insert(look.end(), {"--notes", "off"});
        for (const char* kind : {".png", ".jpg", ".webp"}) {
            if (look[0] == "--bits" && kind != std::string(".png")) continue;
            const ProgramRun first = render(std::string("b") + kind, look);
            const ProgramRun later = tonemap("a.exr", std::string("c") + kind, look);
            EXPECT_TRUE(bytesOf(std::string("b") + kind) == bytesOf(std::string("c") + kind))
                << kind << " " << look[0] << " " << look[1];
        }
    }
}

/// The picture without options is made of means in double precision, as it always was: a byte is
/// another one where a mean is within the rounding to float (2^-24) of the limit of two, as one in
/// 10^5 is. Here there are 2304, none of them is.
TEST_F(Tonemap, MakesThePlainPictureToo) {
    render("a.exr");
    render("b.png", {"--notes", "off"});
    tonemap("a.exr", "c.png", {"--notes", "off"});
    EXPECT_TRUE(bytesOf("b.png") == bytesOf("c.png"));
    render("b.jpg", {"--exposure", "2", "--notes", "off"});
    tonemap("a.exr", "c.jpg", {"--exposure", "2", "--notes", "off"});
    EXPECT_TRUE(bytesOf("b.jpg") == bytesOf("c.jpg"));
}

TEST_F(Tonemap, KeepsTheAlphaAndThePartOfThePicture) {
    const std::vector<std::string> part = {"--transparent", "--crop", "3", "5", "20", "15"};
    const std::vector<std::string> look = {"--view", "agx", "--dither", "on", "--notes", "off"};
    render("a.exr", part);
    std::vector<std::string> both = part;
    both.insert(both.end(), look.begin(), look.end());
    render("b.png", both);
    tonemap("a.exr", "c.png", look);
    EXPECT_EQ(readPng(folder.file("c.png")).width, 20u);
    EXPECT_FALSE(readPng(folder.file("c.png")).alpha.empty());
    EXPECT_TRUE(bytesOf("b.png") == bytesOf("c.png"));
    const ProgramRun refused =
        stromboli({"tonemap", folder.file("a.exr"), "-o", folder.file("c.jpg")});
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_THAT(refused.err, HasSubstr("which has no alpha"));
}

TEST_F(Tonemap, SaysWhatWasMetered) {
    const ProgramRun metered =
        render("a.png", {"--exposure", "auto", "--white-balance", "auto", "--notes", "off"});
    EXPECT_THAT(metered.err, testing::ContainsRegex(
                                 "exposure -?[0-9]+\\.[0-9][0-9] EV, white balance [0-9]+ K"));
    // What it says makes the same picture.
    const size_t stops = metered.err.find("exposure ") + 9,
                 kelvin = metered.err.find("white balance ") + 14;
    render("b.png",
           {"--exposure", metered.err.substr(stops, metered.err.find(" EV", stops) - stops),
            "--white-balance", metered.err.substr(kelvin, metered.err.find(" K", kelvin) - kelvin),
            "--notes", "off"});
    EXPECT_TRUE(bytesOf("a.png") == bytesOf("b.png"));
    EXPECT_THAT(render("c.png").err, Not(HasSubstr("metered")));
}

TEST_F(Tonemap, OfALayerShowsIt) {
    render("a.exr", {"--layers", "albedo,depth"});
    tonemap("a.exr", "picture.png");
    tonemap("a.exr", "albedo.png", {"--layer", "albedo"});
    EXPECT_NE(pixels("picture.png"), pixels("albedo.png"));
    const FloatImage floats = readExr(folder.file("a.exr"));
    const std::vector<uint8_t> albedo = pixels("albedo.png");
    const ToneCurve curve;
    for (size_t i = 0; i < 32 * 24; ++i)
        EXPECT_EQ(albedo[3 * i], curve.toByte(floats.channels.at("albedo.R")[i]));
    const ProgramRun wrong = stromboli(
        {"tonemap", folder.file("a.exr"), "-o", folder.file("b.png"), "--layer", "normals"});
    EXPECT_EQ(wrong.exitCode, 2);
    EXPECT_THAT(wrong.err, HasSubstr("it has no layer 'normals' with colours, but albedo"));
}

TEST_F(Tonemap, TakesOtherPicturesToo) {
    FloatImage radiance(3, 2);
    for (const char* name : kColorChannels)
        radiance.channel(name) = {0, 0.18f, 0.5f, 1, 3, 0.01f};
    writePfm(folder.file("a.pfm"), radiance);
    tonemap("a.pfm", "a.png");
    const ToneCurve curve;
    const std::vector<uint8_t> shown = pixels("a.png");
    for (size_t i = 0; i < 6; ++i)
        EXPECT_EQ(shown[3 * i], curve.toByte(radiance.channels.at("R")[i]));
    tonemap("a.png", "b.png"); // sRGB there and back
    EXPECT_EQ(pixels("a.png"), pixels("b.png"));
    const ProgramRun wrong = stromboli(
        {"tonemap", folder.file("a.png"), "-o", folder.file("c.png"), "--layer", "albedo"});
    EXPECT_EQ(wrong.exitCode, 2);
    EXPECT_THAT(wrong.err, HasSubstr("only OpenEXR files have them"));
}

TEST_F(Tonemap, ErrorsHaveTheirExitCodes) {
    const auto run = [&](const std::string& input, const std::string& output) {
        return stromboli({"tonemap", input, "-o", output});
    };
    EXPECT_EQ(run(folder.file("none.exr"), folder.file("b.png")).exitCode, 2);
    const std::string damaged = folder.write("a.exr", "no picture");
    const ProgramRun refused = run(damaged, folder.file("b.png"));
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.err, HasSubstr("is no picture that is read"));
    EXPECT_EQ(run(damaged, folder.file("none/b.png")).exitCode, 4);
    EXPECT_EQ(run(damaged, folder.file("b.exr")).exitCode, 1);
}

TEST_F(Tonemap, TheFileSaysHowItWasMade) {
    render("a.exr", {"--seed", "7"});
    for (const char* output : {"b.png", "b.jpg", "b.webp"}) {
        tonemap("a.exr", output, {"--view", "agx"});
        EXPECT_EQ(note(output, "Command"),
                  "stromboli tonemap " + folder.file("a.exr") + " --view agx");
        EXPECT_EQ(note(output, "Picture"), folder.file("a.exr"));
        EXPECT_EQ(note(output, "Scene"), scene);
        EXPECT_EQ(note(output, "Seed"), "7");
        EXPECT_THAT(stromboli({"info", folder.file(output)}).out, HasSubstr("  Seed: 7\n"));
    }
}

/// Films of shares become it as one render does, and say so.
TEST_F(Tonemap, MergeMakesTheBytesOfARender) {
    const std::vector<std::string> look = {"--view", "agx", "--exposure", "auto"};
    render("a.jpg", look);
    for (const char* share : {"1", "2"})
        render(std::string(share) + ".film", {"--share", std::string(share) + "/2"});
    std::vector<std::string> words = {"merge", folder.file("1.film"), folder.file("2.film"), "-o",
                                      folder.file("b.jpg")};
    words.insert(words.end(), look.begin(), look.end());
    const ProgramRun merged = stromboli(words);
    EXPECT_EQ(merged.exitCode, 0) << merged.err;
    EXPECT_THAT(merged.err, HasSubstr("EV (metered)"));
    EXPECT_TRUE(bytesOf("a.jpg") == bytesOf("b.jpg"));
    EXPECT_THAT(note("b.jpg", "Command"), HasSubstr("--view agx --exposure auto"));
}

} // namespace
} // namespace stromboli::test
