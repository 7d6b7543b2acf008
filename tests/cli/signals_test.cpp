// Ctrl-C and its kin, at any time: the picture so far or a line, at once, and nothing left behind.
#include "host/film/image_formats.hpp"
#include "tests/cli/running_program.hpp"
#include "tests/support/test_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Waiting ends as soon as what is waited for is there: this is when a test has hung.

/// Seconds of work to make, so that the program is busy with it when the signal comes.
const std::string kLargeScene = "generate:cornell_mesh:4M";

class Signals : public testing::Test {
  protected:
    ScratchFolder folder;
    std::vector<std::string> renderOf(const std::string& scene) const {
        return {"render", scene, "-o", folder.file("a.png"), "--backend", "reference"};
    }
};

class SignalsWhileLoading : public Signals, public testing::WithParamInterface<int> {};

TEST_P(SignalsWhileLoading, EndTheProgramAtOnceWithALine) {
    RunningProgram program(renderOf(kLargeScene), {80});
    ASSERT_TRUE(program.says("loading " + kLargeScene, kSoon)); // after half a second of it
    program.send(GetParam());
    const ProgramRun run = program.finish(kSoon);
    EXPECT_EQ(run.exitCode, 128 + GetParam()) << run.err;
    EXPECT_THAT(run.err, HasSubstr("while loading " + kLargeScene + "\r\n")); // of a terminal
    EXPECT_THAT(folder.entries(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(All, SignalsWhileLoading, testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& one) { return std::string(sigabbrev_np(one.param)); });

/// As under nohup, and behind & in a script.
TEST_F(Signals, ThatWereIgnoredBeforeStayIgnored) {
    RunningProgram program(renderOf(kLargeScene), {80}, {}, {SIGHUP});
    ASSERT_TRUE(program.says("loading " + kLargeScene, kSoon));
    program.send(SIGHUP);
    program.send(
        SIGTERM); // of two signals that wait, SIGHUP has the smaller number and comes first
    EXPECT_EQ(program.finish(kSoon).exitCode, 128 + SIGTERM);
}

TEST_F(Signals, WhileSamplingThePictureSoFarIsWritten) {
    std::vector<std::string> words = renderOf(libraryScene("cornell_boxes.dae"));
    words.insert(words.end(), {"-r", "32", "24", "-s", "10000000"});
    RunningProgram program(words, {80});
    ASSERT_TRUE(program.says("M samples", kSoon));
    program.send(SIGTERM);
    const ProgramRun run = program.finish(kSoon);
    EXPECT_EQ(run.exitCode, 128 + SIGTERM) << run.err;
    EXPECT_THAT(run.err, HasSubstr("interrupted"));
    EXPECT_EQ(readPng(folder.file("a.png")).width, 32u);
    EXPECT_THAT(folder.entries(), ElementsAre("a.png", "a.png.checkpoint"));
}

/// A check has nothing to keep.
TEST_F(Signals, WhileCheckingEndTheProgramAtOnce) {
    RunningProgram program(
        {"check", libraryScene("cornell_boxes.dae"), "-r", "32", "24", "-s", "10000000"}, {80});
    ASSERT_TRUE(program.says("M samples", kSoon)); // once the kernel is compiled
    program.send(SIGINT);
    const ProgramRun run = program.finish(kSoon);
    EXPECT_EQ(run.exitCode, 128 + SIGINT);
    EXPECT_THAT(run.err, HasSubstr("ended by Ctrl-C (SIGINT) while taking samples"));
}

} // namespace
} // namespace stromboli::test
