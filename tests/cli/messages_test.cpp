// What the program says of command lines that it does not understand, or does not heed.
#include "host/cli/command_line.hpp"
#include "host/cli/options.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/core/error.hpp"
#include "host/core/nearest_name.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string refusal(const std::vector<std::string>& words) {
    return refusalOf([&] { parseOptions(words); });
}

std::string renderRefusal(std::vector<std::string> words, const std::string& output = "a.png") {
    words.insert(words.begin(), {"render", "a.dae", "-o", output});
    return refusal(words);
}

std::vector<std::string> remarks(std::vector<std::string> words) {
    return parseOptions(std::move(words))->host.remarks;
}

TEST(NearestName, DistancesCountSingleMistakes) {
    EXPECT_EQ(editDistance("", "abc"), 3u);
    EXPECT_EQ(editDistance("render", "render"), 0u);
    EXPECT_EQ(editDistance("redner", "render"), 1u); // swapped
    EXPECT_EQ(editDistance("rnder", "render"), 1u);
    EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
}

TEST(NearestName, IsNamedIfItIsNear) {
    const std::vector<std::string> names = {"render", "check", "compare", "stress", "study"};
    EXPECT_EQ(nearestName("rendr", names), "render");
    EXPECT_EQ(nearestName("comp", names), "compare");  // as it begins
    EXPECT_EQ(nearestName("st", names), std::nullopt); // as two begin
    EXPECT_EQ(nearestName("paint", names), std::nullopt);
    EXPECT_EQ(nearestName("", names), std::nullopt);
}

TEST(Messages, AnUnknownCommandIsNamed) {
    EXPECT_EQ(refusal({"rendr", "a.dae"}),
              "there is no command 'rendr'; did you mean render? (see --help)");
    EXPECT_EQ(refusal({"nosuch"}), "there is no command 'nosuch' (see --help)");
    EXPECT_THAT(refusal({"a.dae"}), HasSubstr("did you mean stromboli render a.dae -o out.png?"));
    EXPECT_THAT(refusal({"--quiet", "render"}), HasSubstr("--quiet comes before the command"));
}

TEST(Messages, AnOptionThatIsGivenTwiceIsNamed) {
    EXPECT_EQ(refusal({"render", "a.dae", "-o", "a.png", "-r", "64", "48", "-r", "32x24"}),
              "--size is given more than once (see --help)");
    EXPECT_EQ(refusal({"render", "a.dae", "-o", "a.png", "-s", "4", "-s", "8"}),
              "--samples is given more than once (see --help)");
}

TEST(Messages, AnUnknownOptionIsNamedWithOneLikeIt) {
    EXPECT_EQ(renderRefusal({"--sampels", "3"}),
              "render has no option --sampels; did you mean --samples? (see stromboli render "
              "--help)");
    EXPECT_THAT(renderRefusal({"--exposre=2"}), HasSubstr("did you mean --exposure?"));
    EXPECT_THAT(refusal({"check", "a.dae", "--stats", "f"}),
                HasSubstr("check has no option --stats; it is one of render"));
    EXPECT_THAT(renderRefusal({"--teapot"}), Not(HasSubstr("did you mean")));
    EXPECT_EQ(renderRefusal({"--even=false"}), "--even takes no value: --even=false");
}

TEST(Messages, AValueThatIsNoneIsNamedWithOneLikeIt) {
    EXPECT_EQ(renderRefusal({"--integrator", "pth"}),
              "--integrator is 'pth': expected path, normals or depth; did you mean path?");
    EXPECT_THAT(renderRefusal({"--layers", "depth,albdo"}, "a.exr"),
                HasSubstr("did you mean albedo?"));
    EXPECT_THAT(renderRefusal({"--time", "10q"}),
                HasSubstr("maybe with its unit: h, min, m, s, ms"));
}

TEST(Messages, HelpOfACommandIsAlsoACommand) {
    EXPECT_FALSE(parseOptions({"help"}));
    EXPECT_FALSE(parseOptions({"help", "render"}));
    EXPECT_THAT(refusal({"help", "rendr"}), HasSubstr("did you mean render?"));
}

TEST(Messages, WhatCannotHaveAnEffectIsRefused) {
    EXPECT_THAT(renderRefusal({"--aov"}), HasSubstr("--aov needs an EXR file: a.png"));
    EXPECT_THAT(renderRefusal({"--aov"}, "-"), HasSubstr("--aov needs an EXR file"));
    EXPECT_EQ(renderRefusal({"--aov"}, "a.EXR"), "");
    EXPECT_THAT(renderRefusal({"--exposure", "1"}, "a.exr"),
                HasSubstr("--exposure is for pictures of a screen"));
    EXPECT_EQ(renderRefusal({"--exposure", "1"}), "");
    EXPECT_THAT(renderRefusal({"-H", "--direct", "lights"}), HasSubstr("exclude each other"));
    EXPECT_THAT(renderRefusal({"--backend", "reference", "--device", "0"}),
                HasSubstr("--device and --backend reference exclude each other"));
    EXPECT_THAT(renderRefusal({"--gap-proposal", "on", "-H"}),
                HasSubstr("--gap-proposal on needs lights that are sampled"));
    EXPECT_EQ(renderRefusal({"--gap-proposal", "off", "-H"}), "");
    EXPECT_THAT(refusal({"render", "a.dae", "-f", "a.png", "-o", "0", "--min-bounce", "2"}),
                HasSubstr("--accumulate and --min-bounce exclude each other"));
    EXPECT_THAT(refusal({"compare", "a.exr", "b.exr", "--show", "signed"}), HasSubstr("--show"));
}

TEST(Messages, WhatHasNoEffectBesideAnotherOptionIsSaid) {
    EXPECT_THAT(
        remarks({"render", "a.dae", "-o", "a.png", "--stats", "s.json", "-s", "8", "--pixel", "1",
                 "2", "--sample", "0"}),
        ElementsAre("--pixel explains one pixel and makes no picture: ignored: -o, --stats"));
    EXPECT_THAT(remarks({"render", "a.dae", "-o", "a.png", "--integrator", "normals", "-l", "4",
                         "-m", "2"}),
                ElementsAre("--integrator normals follows no light: ignored: -m, -l"));
    EXPECT_THAT(remarks({"render", "a.dae", "-o", "-", "--noise", "0.1"}),
                ElementsAre(HasSubstr("the rate picture is left out")));
    EXPECT_THAT(remarks({"stress", "--list", "--json", "f.json"}),
                ElementsAre("--list runs nothing: ignored: --json"));
    EXPECT_THAT(remarks({"study", "--list", "--seeds", "3"}),
                ElementsAre("--list measures nothing: ignored: --seeds"));
    EXPECT_THAT(remarks({"render", "a.dae", "-o", "a.png", "-s", "8", "-l", "2"}), IsEmpty());
}

TEST(Messages, WhatOnlyLeavesOutIsSaid) {
    EXPECT_THAT(remarks({"bench", "cornell_boxes", "--only", "transfer", "-r", "9", "9", "--seed",
                         "2", "--rays", "3", "-s", "4"}),
                ElementsAre("--only leaves out what asks for it: ignored: SCENE, --rays, -r, "
                            "--seed, -s"));
    EXPECT_THAT(remarks({"bench", "cornell_boxes", "--only", "bvh,rays", "-m", "3", "--sampler",
                         "sobol", "--rays", "2"}),
                ElementsAre(HasSubstr("ignored: -m, --sampler")));
    EXPECT_THAT(remarks({"bench", "--only", "bvh", "--sizes", "1k", "--rays", "2", "-r", "9", "9"}),
                IsEmpty());
    EXPECT_THAT(remarks({"bench", "--only", "variants", "-m", "3", "-s", "2", "-r", "9", "9"}),
                IsEmpty());
    EXPECT_THAT(remarks({"bench", "-m", "3", "-s", "2", "--rays", "2"}), IsEmpty());
}

TEST(Messages, AChoiceOfLightsThatIsNotMadeIsSaid) {
    const auto choosing = [](std::vector<std::string> words) {
        words.insert(words.begin(),
                     {"render", "a.dae", "-o", "a.png", "-s", "1", "--light-choice", "tree"});
        return remarks(std::move(words));
    };
    EXPECT_THAT(choosing({}), IsEmpty());
    EXPECT_THAT(choosing({"--direct", "lights"}), IsEmpty());
    for (const auto& how : {std::vector<std::string>{"-H"}, {"--direct", "hemisphere"}})
        EXPECT_THAT(choosing(how), ElementsAre(HasSubstr("--direct hemisphere finds what shines")));
    EXPECT_THAT(choosing({"--direct", "bsdf"}),
                ElementsAre(HasSubstr("among point, spot and directional lights alone")));
    EXPECT_THAT(choosing({"--cs184"}),
                ElementsAre("--cs184 samples every light in turn: ignored: --light-choice"));
    EXPECT_THAT(choosing({"--backend", "reference"}),
                ElementsAre("the reference samples every light in turn: ignored: --light-choice"));
    EXPECT_THAT(choosing({"--integrator", "normals"}),
                ElementsAre("--integrator normals follows no light: ignored: --light-choice"));
}

TEST(Messages, FirefliesAreSaid) {
    using Unknown = PictureNoise::Unknown;
    PictureNoise noise{Unknown::No, 0.5, 0.3, 0.9, 0.64, 10};
    EXPECT_EQ(
        worstPixelsInWords(noise, false),
        "10 of the pixels have 64 % of its square (fireflies); without them the noise is about "
        "30 %: --denoise spreads them, --clamp-indirect limits them");
    EXPECT_THAT(worstPixelsInWords(noise, true), testing::EndsWith("is about 30 %"));
    noise.ofWorst = 0.49;
    EXPECT_EQ(worstPixelsInWords(noise, false), "");
    EXPECT_EQ(worstPixelsInWords({Unknown::TooFewPixels, 0.5, 0.3, 0.9, 0.64, 10}, false), "");
}

TEST(Messages, WithoutArgumentsTheProgramTeaches) {
    const ProgramRun run = stromboli({});
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, AllOf(HasSubstr("stromboli render SCENE -o out.png"), HasSubstr("--help"),
                               Not(HasSubstr("error"))));
}

} // namespace
} // namespace stromboli::test
