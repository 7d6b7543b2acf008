// Pictures whose shares are taken in rounds, each where the films until then are noisy.
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "tests/cli/film_folder.hpp"
#include "tests/cli/killed_at.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Rounds : public FilmFolder {
  protected:
    std::string scene = libraryScene("cornell_spheres.dae");
    Strings settings = {"-r", "24", "18", "-s", "32", "--block", "4", "-q"};

    Strings render(const std::string& output, const Strings& extra) const {
        return Strings{"render", scene, "-o", folder.file(output)} + settings + extra;
    }
    std::string share(const std::string& name, const std::string& share,
                      const Strings& extra = {}) const {
        run(render(name, Strings{"--share", share} + extra));
        return folder.file(name);
    }
    /// The films of a round: the first, or that of a plan.
    Strings shares(int round, int count, const Strings& extra = {}) const {
        Strings films;
        for (int i = 1; i <= count; ++i) {
            const std::string name = std::to_string(i) + "/" + std::to_string(count);
            films.push_back(share("r" + std::to_string(round) + "." + std::to_string(i) + "of" +
                                      std::to_string(count) + ".film",
                                  name, extra));
        }
        return films;
    }
    Strings shares(int round, int count, const std::string& plan, const Strings& extra = {}) const {
        return shares(round, count, Strings{"--plan", plan} + extra);
    }
    ProgramRun plan(const std::string& output, const Strings& films,
                    const std::string& noise = "0.05", const Strings& extra = {}) const {
        return stromboli(Strings{"plan", "--noise", noise, "-o", folder.file(output)} + extra +
                         films);
    }
};

TEST_F(Rounds, HaveTheSameBytesWhateverTheShares) {
    std::mt19937 random(1);
    std::string exr, png, plan2, plan3;
    for (const int count : {1, 5}) {
        const Strings one = shares(1, count);
        EXPECT_EQ(plan("2.plan", one).exitCode, 0);
        const Strings two = one + shares(2, count, folder.file("2.plan"));
        EXPECT_EQ(plan("3.plan", two).exitCode, 0);
        Strings all = two + shares(3, 8 - count, folder.file("3.plan"));
        std::ranges::shuffle(all, random);
        EXPECT_EQ(merge("sum.exr", all, {"--aov", "--complete"}).exitCode, 0);
        EXPECT_EQ(merge("sum.png", all).exitCode, 0);
        if (exr.empty())
            exr = bytesOf("sum.exr"), png = bytesOf("sum.png"), plan2 = bytesOf("2.plan"),
            plan3 = bytesOf("3.plan");
        EXPECT_TRUE(bytesOf("2.plan") == plan2) << count;
        EXPECT_TRUE(bytesOf("3.plan") == plan3) << count;
        EXPECT_TRUE(bytesOf("sum.exr") == exr) << count;
        EXPECT_TRUE(bytesOf("sum.png") == png) << count;

        const auto half = all.begin() + std::ptrdiff_t(all.size() / 2);
        EXPECT_EQ(merge("a.film", {all.begin(), half}).exitCode, 0);
        EXPECT_EQ(merge("b.film", {half, all.end()}).exitCode, 0);
        EXPECT_EQ(
            merge("sum.exr", {folder.file("b.film"), folder.file("a.film")}, {"--aov"}).exitCode,
            0);
        EXPECT_TRUE(bytesOf("sum.exr") == exr) << count << ", on two levels";
    }
    EXPECT_THAT(note("sum.exr", "Samples"), HasSubstr("a pixel, in 3 rounds"));
    EXPECT_THAT(note("sum.exr", "Noise"), HasSubstr("about "));
}

/// Where rounds go on until all pixels have 48 samples, these are the first 48, each once: but for
/// roundings, the picture is that of one render.
TEST_F(Rounds, GoOnWithTheNextSamples) {
    settings = settings + Strings{"--transparent", "--look-from", "0", "1", "9"};
    Strings films = shares(1, 2);
    for (int round = 2;; ++round) {
        const std::string name = std::to_string(round) + ".plan";
        const int code = plan(name, films, "0.0001", {"-s", "48"}).exitCode;
        if (code == kNothingLeft) break;
        ASSERT_EQ(code, 0);
        films = films + shares(round, 3, folder.file(name));
    }
    EXPECT_GT(films.size(), 2u);
    settings[4] = "48"; // -s
    EXPECT_EQ(merge("sum.exr", films, {"--aov"}).exitCode, 0);
    run(render("whole.exr", {"--even", "--aov"}));
    const FloatImage sum = readExr(folder.path() / "sum.exr");
    const FloatImage whole = readExr(folder.path() / "whole.exr");
    for (const char* name : {"R", "G", "B", "A", "samples", "variance.R"}) {
        const std::vector<float>&a = sum.channels.at(name), &b = whole.channels.at(name);
        for (size_t i = 0; i < a.size(); ++i)
            ASSERT_NEAR(a[i], b[i], 1e-5 * b[i] + 1e-9) << name << " of pixel " << i;
    }
}

TEST_F(Rounds, OfTheReferenceToo) {
    const Strings small = {"--backend", "reference", "--crop", "3", "2", "9", "7"};
    const Strings one = shares(1, 2, small);
    EXPECT_EQ(plan("2.plan", one).exitCode, 0);
    EXPECT_EQ(merge("a.exr", one + shares(2, 1, folder.file("2.plan"), small)).exitCode, 0);
    EXPECT_EQ(merge("b.exr", one + shares(2, 3, folder.file("2.plan"), small)).exitCode, 0);
    EXPECT_TRUE(bytesOf("a.exr") == bytesOf("b.exr"));
}

/// Branches, and bands of a film that does not fit the memory.
TEST_F(Rounds, InBands) {
    settings = {"-r", "120", "90", "-s", "32", "--block", "16", "--branches", "4", "-q"};
    const Strings one = shares(1, 1);
    EXPECT_EQ(plan("2.plan", one).exitCode, 0);
    const Strings whole = shares(2, 2, folder.file("2.plan"));
    EXPECT_EQ(merge("a.exr", one + whole).exitCode, 0);
    const Strings inBands = shares(2, 2, folder.file("2.plan"), {"--film-memory", "2"});
    EXPECT_EQ(merge("b.exr", one + inBands).exitCode, 0);
    EXPECT_TRUE(bytesOf("a.exr") == bytesOf("b.exr"));
    const ProgramRun odd = plan("3.plan", one, "0.01", {"-s", "67"});
    EXPECT_EQ(odd.exitCode, 1);
    EXPECT_THAT(odd.err, HasSubstr("-s 67 is not a multiple of the 4 --branches of the films"));
}

/// The noise that merge states is that of one render, also where a pixel filter is negative in
/// places, and pixels with it.
TEST_F(Rounds, TheNoiseOfTheFirstOneIsThatOfOneRender) {
    const auto noiseLine = [](const std::string& said) {
        const size_t begin = said.find("noise about ");
        return said.substr(begin, said.find('\n', begin) - begin);
    };
    settings.pop_back(); // -q
    for (const char* filter : {"box", "lanczos"}) {
        const Strings extra = {"--filter", filter};
        const ProgramRun whole = stromboli(render("whole.exr", Strings{"--even"} + extra));
        const ProgramRun sum = merge("sum.exr", shares(1, 3, extra));
        EXPECT_THAT(whole.err, HasSubstr("noise about "));
        EXPECT_EQ(noiseLine(sum.err), noiseLine(whole.err)) << filter;
        EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr")) << filter;
        EXPECT_EQ(note("sum.exr", "Noise"), "none"); // as there is none in the notes of a render
    }
}

TEST_F(Rounds, EndWithAnExitCodeOfTheirOwn) {
    const Strings one = shares(1, 1);
    const ProgramRun enough = plan("2.plan", one, "10");
    EXPECT_EQ(enough.exitCode, kNothingLeft);
    EXPECT_THAT(enough.err, HasSubstr("nothing is left to do: noise about "));
    const ProgramRun all = plan("2.plan", one, "0.001", {"-s", "32"});
    EXPECT_EQ(all.exitCode, kNothingLeft);
    EXPECT_THAT(all.err, HasSubstr("all pixels have the samples of -s"));
    EXPECT_FALSE(std::filesystem::exists(folder.file("2.plan")));
    const ProgramRun more = plan("2.plan", one, "0.001", {"-s", "36"});
    EXPECT_EQ(more.exitCode, 0);
    EXPECT_THAT(more.err, HasSubstr("round 2: "));
    EXPECT_THAT(more.err, HasSubstr("432 pixels: from 32 to "));
}

TEST_F(Rounds, WhatDoesNotBelongTogetherIsRefused) {
    const Strings one = shares(1, 2);
    const ProgramRun part = plan("2.plan", {one[1]});
    EXPECT_EQ(part.exitCode, 1);
    EXPECT_THAT(part.err, HasSubstr("the next round cannot be planned: share 1 of 2 is missing"));
    EXPECT_EQ(plan("2.plan", one).exitCode, 0);
    const std::string two = folder.file("2.plan");
    const auto refusal = [&](const Strings& extra) {
        const ProgramRun program =
            stromboli(render("x.film", Strings{"--share", "1/2", "--plan", two} + extra));
        EXPECT_EQ(program.exitCode, 1) << program.err;
        EXPECT_FALSE(std::filesystem::exists(folder.file("x.film")));
        return program.err;
    };
    EXPECT_THAT(refusal({"--seed", "5"}), HasSubstr("2.plan is of other settings"));
    EXPECT_THAT(refusal({"--look-from", "1", "2", "3"}), HasSubstr("2.plan is of another scene"));
    EXPECT_THAT(refusal({"--backend", "reference"}), HasSubstr("2.plan is of the backend vulkan"));
    const ProgramRun whole = stromboli({"render", scene, "-o", "x.exr", "--plan", two});
    EXPECT_THAT(whole.err, HasSubstr("--plan requires --share"));
    EXPECT_THAT(plan("2.txt", one).err, HasSubstr("whose name must end in .plan"));
    EXPECT_THAT(stromboli({"plan", one[0], "-o", two}).err, HasSubstr("--noise is required"));

    const std::string film = share("two.film", "1/2", {"--plan", two});
    const ProgramRun alone = merge("x.exr", {film});
    EXPECT_EQ(alone.exitCode, 1);
    EXPECT_THAT(alone.err, HasSubstr("the films have no samples of the first round"));
    EXPECT_EQ(merge("x.exr", one + Strings{film}, {"--complete"}).exitCode, 1);
    const ProgramRun some = merge("x.exr", one + Strings{film});
    EXPECT_EQ(some.exitCode, 0);
    EXPECT_THAT(note("x.exr", "Samples"), HasSubstr("of round 2 share 2 of 2 is missing"));

    EXPECT_EQ(plan("other.plan", one, "0.03", {"-s", "48"}).exitCode, 0);
    const ProgramRun mixed = merge(
        "y.exr",
        one + Strings{film, share("other.film", "2/2", {"--plan", folder.file("other.plan")})});
    EXPECT_EQ(mixed.exitCode, 1);
    EXPECT_THAT(mixed.err, HasSubstr("other.film follows another plan of round 2"));

    const ProgramRun twice = merge("y.exr", one + Strings{film, film});
    EXPECT_THAT(twice.err, HasSubstr("share 1/2 of round 2 would be counted twice"));
}

TEST_F(Rounds, FilmsThatAreThereAreKept) {
    EXPECT_EQ(plan("2.plan", shares(1, 1)).exitCode, 0);
    const Strings planned = {"--plan", folder.file("2.plan")};
    share("a.film", "1/2", planned);
    const std::string whole = bytesOf("a.film");
    settings.pop_back(); // -q
    const auto again = [&](const std::string& name, const Strings& extra) {
        return stromboli(render("a.film", Strings{"--share", name, "--resume"} + extra));
    };
    EXPECT_THAT(again("1/2", planned).err, HasSubstr("a.film is there already"));
    EXPECT_THAT(again("2/2", planned).err, HasSubstr("is of other shares"));
    EXPECT_THAT(again("1/2", {}).err, HasSubstr("is of round 2, not of 1"));
    std::ofstream(folder.file("a.film"), std::ios::binary) << whole.substr(0, whole.size() / 2);
    EXPECT_THAT(again("1/2", planned).err, HasSubstr("the share is taken anew"));
    EXPECT_TRUE(bytesOf("a.film") == whole);
    const ProgramRun elsewhere =
        again("1/2", planned + Strings{"--expect", "00000000-0123456789abcdef"});
    EXPECT_THAT(elsewhere.err, HasSubstr("is not the one that was submitted"));
}

/// Killed while it is written, it leaves no film or the whole one; taken again, it has the bytes it
/// has unharmed.
TEST_F(Rounds, AShareThatIsKilledCostsThatShare) {
    settings = {"-r", "24", "18", "-s", "512", "--block", "128", "-q"};
    const Strings one = shares(1, 1);
    EXPECT_EQ(plan("2.plan", one, "0.0001").exitCode, 0);
    const Strings two = shares(2, 2, folder.file("2.plan"));
    EXPECT_EQ(merge("whole.exr", one + two).exitCode, 0);
    const Strings words =
        render("r2.2of2.film", {"--share", "2/2", "--plan", folder.file("2.plan")});
    const std::string film = bytesOf("r2.2of2.film");
    uint32_t kills = 0;
    for (int exitCode = kWasKilled; exitCode == kWasKilled; ++kills) {
        std::filesystem::remove(two[1]);
        const ProgramRun run = stromboli(words, killedAt(folder, kills + 1));
        exitCode = run.exitCode;
        ASSERT_TRUE(exitCode == 0 || exitCode == kWasKilled) << run.err;
        const std::string left = bytesOf("r2.2of2.film");
        EXPECT_TRUE(left == film || (left.empty() && exitCode == kWasKilled));
    }
    EXPECT_GT(kills, 5u);
    EXPECT_EQ(merge("sum.exr", one + two).exitCode, 0);
    EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr"));
}

} // namespace
} // namespace stromboli::test
