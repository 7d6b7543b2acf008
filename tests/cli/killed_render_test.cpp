// A render that is killed again and again, while it writes its files, loses next to nothing and
// never a file. It is killed by the number of its writes, so that a busy machine changes nothing.
#include "tests/cli/killed_at.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>

namespace stromboli::test {
namespace {

class KilledRender : public testing::Test {
  protected:
    ScratchFolder folder;

    /// Hundreds of milliseconds of samples, with a checkpoint every ten.
    std::vector<std::string> arguments(const std::string& output) const {
        return {"render", libraryScene("cornell_spheres.dae"),
                "-o",     folder.file(output),
                "-r",     "48",
                "36",     "-s",
                "1024",   "--checkpoint-every",
                "0.01",   "--resume",
                "-q"};
    }

    /// Killed at the n-th write (killedAt()).
    ProgramRun runUntil(uint32_t n, const std::vector<std::string>& words) const {
        return stromboli(words, killedAt(folder, n));
    }

    std::string bytesOf(const std::string& name) const {
        std::ifstream file(folder.path() / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
};

/// A checkpoint takes three or four writes, counted as killedAt() counts: with fewer nothing is
/// gained, with more the next one begins. Killed once at each of twenty, in no order, so that what
/// is left of a run is what another begins with.
TEST_F(KilledRender, TwentyTimesHasTheSameBytes) {
    ASSERT_EQ(stromboli(arguments("whole.exr")).exitCode, 0);
    const std::string whole = bytesOf("whole.exr");
    ASSERT_FALSE(whole.empty());

    std::vector<uint32_t> writes(20);
    std::iota(writes.begin(), writes.end(), 1u);
    std::mt19937 random(1);
    std::shuffle(writes.begin(), writes.end(), random);
    int finished = 0, withFile = 0;
    while (!writes.empty() && finished < 50) {
        const ProgramRun run = runUntil(writes.back(), arguments("a.exr"));
        if (run.exitCode == kWasKilled) {
            writes.pop_back();
            withFile += std::filesystem::exists(folder.file("a.exr.checkpoint"));
            const std::string left = bytesOf("a.exr");
            EXPECT_TRUE(left.empty() || left == whole);
            continue;
        }
        ASSERT_EQ(run.exitCode, 0) << run.err;
        EXPECT_TRUE(bytesOf("a.exr") == whole);
        std::filesystem::remove(folder.file("a.exr"));
        ++finished;
    }
    EXPECT_TRUE(writes.empty());
    EXPECT_GT(withFile, 5); // it was killed while it had something to lose
    const ProgramRun last = stromboli(arguments("a.exr"));
    ASSERT_EQ(last.exitCode, 0) << last.err;
    EXPECT_TRUE(bytesOf("a.exr") == whole);
    EXPECT_THAT(folder.entries(), testing::UnorderedElementsAre("a.exr", "whole.exr"));
}

/// The bands that are done are kept, and the one under way is.
TEST_F(KilledRender, InBandsHasTheSameBytesToo) {
    const auto inBands = [&](const std::string& output, bool resumes) {
        std::vector<std::string> words = {"render",
                                          libraryScene("cornell_spheres.dae"),
                                          "-o",
                                          folder.file(output),
                                          "-r",
                                          "120",
                                          "90",
                                          "-s",
                                          "240",
                                          "--checkpoint-every",
                                          "0.01",
                                          "-q",
                                          "--film-memory",
                                          "1"};
        if (resumes) words.push_back("--resume");
        return words;
    };
    const auto checkpoints = [&] {
        int bands = 0;
        for (const std::string& name : folder.entries())
            bands += name.starts_with("a.exr.checkpoint.band");
        return bands;
    };
    const ProgramRun undisturbed = stromboli(inBands("whole.exr", false));
    ASSERT_EQ(undisturbed.exitCode, 0) << undisturbed.err;
    const std::string whole = bytesOf("whole.exr");
    ASSERT_FALSE(whole.empty());
    EXPECT_EQ(folder.entries().size(), 1u); // the picture

    std::mt19937 random(2);
    int kills = 0, mostBands = 0;
    for (int exitCode = kWasKilled; exitCode == kWasKilled && kills < 1000;) {
        // So that the first runs write a checkpoint, which each dispatch makes, and none of the
        // last band. Later ones go on for longer: how many dispatches a picture takes is the
        // machine's affair.
        std::uniform_int_distribution<uint32_t> writes(3, uint32_t(5 + 2 * kills));
        const ProgramRun run = runUntil(writes(random), inBands("a.exr", kills > 0));
        exitCode = run.exitCode;
        mostBands = std::max(mostBands, checkpoints());
        ASSERT_TRUE(exitCode == 0 || exitCode == kWasKilled) << run.err;
        kills += exitCode == kWasKilled;
    }
    EXPECT_TRUE(bytesOf("a.exr") == whole);
    EXPECT_GT(kills, 2);
    EXPECT_GT(mostBands, 1);
    EXPECT_EQ(checkpoints(), 0);
}

TEST_F(KilledRender, BandsCanBeExtendedAndAreWhatTheyWere) {
    const auto render = [&](const std::string& output, const std::string& samples,
                            std::vector<std::string> extra) {
        std::vector<std::string> words = {"render",       libraryScene("cornell_spheres.dae"),
                                          "-o",           folder.file(output),
                                          "-r",           "120",
                                          "90",           "-s",
                                          samples,        "--even",
                                          "--checkpoint", folder.file("kept")};
        words.insert(words.end(), extra.begin(), extra.end());
        return stromboli(words);
    };
    ASSERT_EQ(render("a.exr", "4", {"--film-memory", "1"}).exitCode, 0);
    EXPECT_FALSE(std::filesystem::exists(folder.file("kept")));
    const ProgramRun more = render("a.exr", "8", {"--resume"}); // with all of the memory
    EXPECT_EQ(more.exitCode, 0) << more.err;
    EXPECT_THAT(more.err, testing::ContainsRegex("rendering [0-9]+ bands, .* as before"));
    EXPECT_THAT(more.err, testing::HasSubstr("which has 4.0 samples a pixel"));
    const ProgramRun small =
        render("c.exr", "8", {"--resume", "--film-memory", "1", "--crop", "0", "0", "120", "1"});
    EXPECT_EQ(small.exitCode, 1);
    EXPECT_THAT(small.err, testing::HasSubstr("give the same -r and --crop"));
    // Begun anew in one piece, it forgets the bands.
    ASSERT_EQ(render("b.exr", "8", {}).exitCode, 0);
    EXPECT_TRUE(bytesOf("a.exr") == bytesOf("b.exr"));
    for (const std::string& name : folder.entries())
        EXPECT_EQ(name.find(".band"), std::string::npos) << name;
    const ProgramRun whole = render("c.exr", "8", {"--resume", "--film-memory", "1"});
    EXPECT_EQ(whole.exitCode, 1);
    EXPECT_THAT(whole.err, testing::HasSubstr("in one piece, which does not fit the memory here"));
}

TEST_F(KilledRender, AFinishedOneCanBeExtended) {
    const auto render = [&](const std::string& output, const std::string& samples, bool resumes) {
        std::vector<std::string> words = {"render",       libraryScene("cornell_spheres.dae"),
                                          "-o",           folder.file(output),
                                          "-r",           "32",
                                          "24",           "-s",
                                          samples,        "--even",
                                          "--checkpoint", folder.file("kept")};
        if (resumes) words.push_back("--resume");
        const ProgramRun run = stromboli(words);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return run.err;
    };
    render("a.exr", "64", false);
    EXPECT_THAT(render("a.exr", "256", true),
                testing::HasSubstr("goes on from " + folder.file("kept") +
                                   ", which has 64.0 samples a pixel"));
    render("b.exr", "256", false);
    EXPECT_TRUE(bytesOf("a.exr") == bytesOf("b.exr"));
}

TEST_F(KilledRender, WithoutACheckpointItBeginsAnewAndSaysSo) {
    const ProgramRun run = stromboli({"render", libraryScene("cornell_spheres.dae"), "-o",
                                      folder.file("a.exr"), "-r", "8", "6", "-s", "1", "--resume"});
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_THAT(run.err, testing::HasSubstr("there is no " + folder.file("a.exr.checkpoint") +
                                            ": the render begins anew"));
}

TEST_F(KilledRender, AnotherRenderIsRefused) {
    const auto render = [&](std::vector<std::string> extra) {
        std::vector<std::string> words = {"render",
                                          libraryScene("cornell_spheres.dae"),
                                          "-o",
                                          folder.file("a.exr"),
                                          "-r",
                                          "8",
                                          "6",
                                          "--checkpoint",
                                          folder.file("kept")};
        words.insert(words.end(), extra.begin(), extra.end());
        return stromboli(words);
    };
    ASSERT_EQ(render({"-s", "4"}).exitCode, 0);
    const ProgramRun run = render({"-s", "4", "--seed", "2", "--resume"});
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_THAT(run.err, testing::HasSubstr("the checkpoint is of other settings"));
}

} // namespace
} // namespace stromboli::test
