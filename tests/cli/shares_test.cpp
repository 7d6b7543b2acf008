// Pictures that several runs of the program render together.
#include "host/film/image_file.hpp"
#include "tests/cli/film_folder.hpp"
#include "tests/cli/killed_at.hpp"
#include "tests/cli/running_program.hpp"
#include "tests/support/shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <random>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

class Shares : public FilmFolder {
  protected:
    std::string scene = libraryScene("cornell_spheres.dae");

    /// 60 samples a pixel, in blocks of 8: the last one has 4.
    Strings render(const std::string& output, const Strings& extra,
                   const std::string& samples = "60") const {
        Strings words = {"render", scene, "-o",    folder.file(output), "-r", "24",
                         "18",     "-s",  samples, "--block",           "8",  "-q"};
        words.insert(words.end(), extra.begin(), extra.end());
        return words;
    }
    std::string share(uint32_t index, uint32_t count, const Strings& extra = {}) const {
        const std::string name =
            "part" + std::to_string(index) + "of" + std::to_string(count) + ".film";
        Strings words = extra;
        words.insert(words.end(), {"--share", std::to_string(index) + "/" + std::to_string(count)});
        run(render(name, words));
        return folder.file(name);
    }
    Strings shares(uint32_t count, const Strings& extra = {}) const {
        Strings files;
        for (uint32_t i = 1; i <= count; ++i)
            files.push_back(share(i, count, extra));
        return files;
    }
};

TEST_F(Shares, AddUpToTheBytesOfOneRender) {
    run(render("whole.exr", {"--even", "--aov"}));
    run(render("whole.png", {"--even", "--exposure", "0.5"}));
    std::mt19937 random(1);
    for (uint32_t count : {1u, 2u, 7u}) {
        Strings films = shares(count);
        std::shuffle(films.begin(), films.end(), random);
        EXPECT_EQ(merge("sum.exr", films, {"--aov"}).exitCode, 0);
        EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr")) << count;
        EXPECT_EQ(merge("sum.png", films, {"--exposure", "0.5"}).exitCode, 0);
        EXPECT_TRUE(bytesOf("sum.png") == bytesOf("whole.png")) << count;
    }
    EXPECT_EQ(note("sum.png", "Samples"), "60 a pixel");
}

TEST_F(Shares, OfTheReferenceDoSoToo) {
    const Strings small = {"--backend", "reference", "--crop", "3", "2", "9", "7"};
    Strings even = small;
    even.emplace_back("--even");
    run(render("whole.exr", even));
    EXPECT_EQ(merge("sum.exr", shares(3, small)).exitCode, 0);
    EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr"));
}

/// Branches of paths, bands of a film that does not fit the memory, and films of films.
TEST_F(Shares, InBandsAndOnTwoLevels) {
    const Strings branched = {"--branches", "4", "-r", "120", "90"};
    Strings even = branched, inBands = branched;
    even.emplace_back("--even");
    inBands.insert(inBands.end(), {"--film-memory", "2"});
    const auto words = [&](const std::string& output, Strings extra) {
        Strings all = {"render",  scene, "-o", folder.file(output), "-s", "32",
                       "--block", "8",   "-q"};
        all.insert(all.end(), extra.begin(), extra.end());
        return all;
    };
    run(words("whole.exr", even));
    Strings films;
    for (const char* share : {"1/4", "2/4", "3/4", "4/4"}) {
        Strings extra = films.size() % 2 == 0 ? branched : inBands;
        extra.insert(extra.end(), {"--share", share});
        films.push_back(folder.file(std::string("part") + share[0] + ".film"));
        run(words(std::string("part") + share[0] + ".film", extra));
    }
    EXPECT_EQ(merge("a.film", {films[3], films[0]}).exitCode, 0);
    EXPECT_EQ(merge("b.film", {films[1], films[2]}).exitCode, 0);
    EXPECT_EQ(merge("sum.exr", {folder.file("b.film"), folder.file("a.film")}).exitCode, 0);
    EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr"));
}

/// Samples that a surface covers are counted; layers are in the film of the first samples.
TEST_F(Shares, HaveAlphaAndLayers) {
    const Strings seen = {"--transparent", "--layers",
                          "albedo,normal,depth,position,uv,object,material"};
    const auto with = [](Strings words, const Strings& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    run(render("whole.exr", with(seen, {"--even"})));
    run(render("whole.png", {"--even", "--transparent"}));
    for (uint32_t count : {1u, 3u}) { // and 7, below
        const Strings films = shares(count, seen);
        EXPECT_EQ(merge("sum.exr", films).exitCode, 0);
        EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr")) << count;
    }
    Strings films = shares(7, with(seen, {"--film-memory", "1"}));
    EXPECT_EQ(merge("a.film", {films[3], films[0], films[6]}).exitCode, 0);
    EXPECT_EQ(merge("b.film", {films[5], films[1], films[2], films[4]}).exitCode, 0);
    EXPECT_EQ(merge("sum.exr", {folder.file("b.film"), folder.file("a.film")}).exitCode, 0);
    EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr"));

    const ProgramRun png = merge("sum.png", films);
    EXPECT_THAT(png.err, HasSubstr("sum.png has no channels for the layers of the films"));
    EXPECT_EQ(merge("sum.png", shares(3, {"--transparent"})).exitCode, 0);
    EXPECT_TRUE(bytesOf("sum.png") == bytesOf("whole.png"));

    const ProgramRun without = merge("part.exr", {films[1], films[2]});
    EXPECT_THAT(without.err,
                HasSubstr("the layers are missing: they are in the film of the first"));
    const ProgramRun weighted =
        stromboli(render("w.film", {"--share", "1/2", "--transparent", "--filter", "lanczos"}));
    EXPECT_EQ(weighted.exitCode, 1);
    EXPECT_THAT(weighted.err, HasSubstr("--filter box"));
    const ProgramRun mixed = merge("x.exr", {films[1], share(3, 7, {"--transparent"})});
    EXPECT_EQ(mixed.exitCode, 1);
    EXPECT_THAT(mixed.err, HasSubstr("part3of7.film has other --layers"));
    const ProgramRun opaque = merge("x.exr", {films[1], share(4, 7)});
    EXPECT_THAT(opaque.err, HasSubstr("part4of7.film is of other settings"));
}

TEST_F(Shares, ThatAreMissingAreNamed) {
    const Strings films = {share(1, 4), share(4, 4)};
    const ProgramRun run = merge("part.exr", films);
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_THAT(run.err, HasSubstr("28 a pixel of 60; shares 2 to 3 of 4 are missing"));
    EXPECT_EQ(note("part.exr", "Samples"), "28 a pixel of 60; shares 2 to 3 of 4 are missing");
    const ProgramRun whole = merge("whole.exr", films, {"--complete"});
    EXPECT_EQ(whole.exitCode, 1);
    EXPECT_THAT(whole.err, HasSubstr("whole.exr is not written: shares 2 to 3 of 4 are missing"));
    EXPECT_FALSE(std::filesystem::exists(folder.file("whole.exr")));
}

TEST_F(Shares, OfOtherRendersAreRefused) {
    const std::string first = share(1, 2);
    const auto refusal = [&](uint32_t index, uint32_t count, const Strings& extra) {
        const ProgramRun run = merge("sum.exr", {first, share(index, count, extra)});
        EXPECT_EQ(run.exitCode, 1);
        return run.err;
    };
    EXPECT_THAT(refusal(2, 2, {"--seed", "5"}), HasSubstr("part2of2.film is of other settings"));
    EXPECT_THAT(refusal(2, 2, {"--look-from", "1", "2", "3"}),
                HasSubstr("is of another scene or camera"));
    EXPECT_THAT(refusal(2, 2, {"--backend", "reference"}), HasSubstr("the backend reference"));
    EXPECT_THAT(refusal(1, 4, {}),
                HasSubstr("samples 0 to 15 of each pixel would be counted twice"));
    EXPECT_FALSE(std::filesystem::exists(folder.file("sum.exr")));
}

TEST_F(Shares, SayWhichOptionsHaveNoPlace) {
    const auto refusal = [&](const std::string& output, const Strings& extra) {
        Strings words = {"render", scene, "-o", folder.file(output), "--share", "1/2"};
        words.insert(words.end(), extra.begin(), extra.end());
        const ProgramRun run = stromboli(words);
        EXPECT_EQ(run.exitCode, 1);
        return run.err;
    };
    EXPECT_THAT(refusal("a.png", {}), HasSubstr("whose name must end in .film"));
    EXPECT_THAT(refusal("a.film", {"--noise", "0.1"}),
                HasSubstr("--share and --noise exclude each other: a share has as many samples"));
    EXPECT_THAT(refusal("a.film", {"-a", "8", "0.1"}), HasSubstr("--share and -a exclude"));
    EXPECT_THAT(refusal("a.film", {"--exposure", "1"}), HasSubstr("merge has it"));
    const ProgramRun share = stromboli({"render", scene, "-o", "a.film", "--share", "3/2"});
    EXPECT_THAT(share.err, HasSubstr("--share: I"));
    const ProgramRun picture = stromboli({"render", scene, "-o", "a.film"});
    EXPECT_EQ(picture.exitCode, 1);
    EXPECT_THAT(picture.err, HasSubstr("unknown kind of picture"));
    const ProgramRun film = merge("a.film", {folder.file("b.film")}, {"--aov"});
    EXPECT_THAT(film.err, HasSubstr("a film has no --aov"));
}

TEST_F(Shares, AreKeptIfTheyAreThereAlready) {
    const std::string film = share(1, 2);
    const auto before = std::filesystem::last_write_time(film);
    Strings words = render("part1of2.film", {"--share", "1/2", "--resume"});
    words.erase(std::find(words.begin(), words.end(), "-q"));
    const ProgramRun again = stromboli(words);
    EXPECT_EQ(again.exitCode, 0);
    EXPECT_THAT(again.err, HasSubstr("part1of2.film is there already"));
    EXPECT_EQ(std::filesystem::last_write_time(film), before);

    words[words.size() - 2] = "2/2";
    const ProgramRun other = stromboli(words);
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_THAT(other.err, HasSubstr("is of other shares; --resume keeps films of this share"));

    words[words.size() - 2] = "1/2";
    const std::string whole = bytesOf("part1of2.film");
    std::ofstream(film, std::ios::binary) << whole.substr(0, whole.size() / 2);
    const ProgramRun damaged = stromboli(words);
    EXPECT_EQ(damaged.exitCode, 0);
    EXPECT_THAT(damaged.err, HasSubstr("the film is cut short; the share is taken anew"));
    EXPECT_TRUE(bytesOf("part1of2.film") == whole);
}

/// What a node has is not what was submitted.
TEST_F(Shares, BeginOnlyWithTheSceneThatIsExpected) {
    const ProgramRun run =
        stromboli(render("a.film", {"--share", "1/2", "--expect", "00000000-0123456789abcdef"}));
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_THAT(run.err, HasSubstr("the scene or its camera is not the one that was submitted"));
    const std::string here = run.err.substr(run.err.find("fingerprint is ") + 15, 25);
    EXPECT_EQ(stromboli(render("a.film", {"--share", "1/2", "--expect", here})).exitCode, 0);
    const ProgramRun build = stromboli(
        render("a.film", {"--share", "1/2", "--expect", here.substr(0, 9) + "0123456789abcdef"}));
    EXPECT_EQ(build.exitCode, 2);
    EXPECT_THAT(build.err, HasSubstr("takes other samples than the one that submitted it"));
}

/// Wherever it is killed, there is no film or the whole one, and no other file in the end.
TEST_F(Shares, ThatAreKilledLeaveNoHalfOfAFilm) {
    const Strings words = render("a.film", {"--share", "1/2"});
    run(words);
    const std::string whole = bytesOf("a.film");
    ASSERT_FALSE(whole.empty());
    uint32_t kills = 0;
    for (int exitCode = kWasKilled; exitCode == kWasKilled; ++kills) {
        std::filesystem::remove(folder.file("a.film"));
        const ProgramRun run = stromboli(words, killedAt(folder, kills + 1));
        exitCode = run.exitCode;
        ASSERT_TRUE(exitCode == 0 || exitCode == kWasKilled) << run.err;
        const std::string left = bytesOf("a.film");
        EXPECT_TRUE(left == whole || (left.empty() && exitCode == kWasKilled));
    }
    EXPECT_GT(kills, 5u);
    EXPECT_EQ(folder.entries().size(), 1u) << "temporary files are left";
}

TEST_F(Shares, ThatAreInterruptedWriteNothing) {
    Strings words = render("a.film", {"--share", "1/2"}, "10M");
    words.erase(std::find(words.begin(), words.end(), "-q"));
    RunningProgram program(words, {80});
    ASSERT_TRUE(program.says("samples", 250));
    program.send(SIGINT);
    const ProgramRun run = program.finish(250);
    EXPECT_EQ(run.exitCode, 128 + SIGINT) << run.err;
    EXPECT_TRUE(folder.entries().empty());
}

/// Sums in blocks cannot become sums of all samples one after the other, or the reverse.
TEST_F(Shares, ARenderGoesOnInTheBlocksThatItBeganWith) {
    const Strings kept = {"--checkpoint", folder.file("kept")};
    const auto words = [&](Strings extra) {
        extra.insert(extra.end(), kept.begin(), kept.end());
        Strings all = {"render", scene, "-o", folder.file("a.exr"), "-r", "24", "18", "-q"};
        all.insert(all.end(), extra.begin(), extra.end());
        return all;
    };
    run(words({"-s", "60", "--even", "--block", "8"}));
    const ProgramRun spread = stromboli(words({"-s", "90", "--resume"}));
    EXPECT_EQ(spread.exitCode, 1);
    EXPECT_THAT(spread.err, HasSubstr("added up in blocks of 8; give the same --even and --block"));
    run(words({"-s", "90", "--even", "--block", "8", "--resume"}));
    const std::string extended = bytesOf("a.exr");
    std::filesystem::remove(folder.file("kept"));
    run(words({"-s", "90", "--even", "--block", "8"}));
    EXPECT_TRUE(bytesOf("a.exr") == extended);
}

/// One task fails at first, and only it is done again.
TEST_F(Shares, RunUnderGnuParallel) {
    if (!isInstalled("parallel") ||
        shell("parallel --version").output.find("GNU") == std::string::npos)
        GTEST_SKIP() << "GNU parallel is not installed";
    run(render("whole.exr", {"--even"}));
    const std::string parallel =
        "cd " + folder.path().string() +
        "; parallel -j2 --joblog log --resume-failed 'test {} != 3 -o -e ready && " +
        STROMBOLI_PROGRAM + " render " + scene +
        " -r 24 18 -s 60 --block 8 -q --share {}/8 -o part.{}.film' ::: $(seq 8)\n";
    const ShellRun first = shell(parallel);
    EXPECT_EQ(first.exitCode, 1) << first.output; // the number of failures
    EXPECT_FALSE(std::filesystem::exists(folder.file("part.3.film")));
    const auto before = std::filesystem::last_write_time(folder.file("part.2.film"));
    std::ofstream(folder.file("ready")) << "";
    const ShellRun second = shell(parallel);
    EXPECT_EQ(second.exitCode, 0) << second.output;
    EXPECT_EQ(std::filesystem::last_write_time(folder.file("part.2.film")), before);
    Strings films;
    for (int i = 1; i <= 8; ++i)
        films.push_back(folder.file("part." + std::to_string(i) + ".film"));
    EXPECT_EQ(merge("sum.exr", films, {"--complete"}).exitCode, 0);
    EXPECT_TRUE(bytesOf("sum.exr") == bytesOf("whole.exr"));
}

} // namespace
} // namespace stromboli::test
