// What is drawn in place on a terminal, and where nothing is.
#include "host/cli/progress.hpp"
#include "tests/cli/running_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>

#include <sstream>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kErase = "\r\033[K";

class OnTerminal : public testing::Test {
  protected:
    ScratchFolder folder;

    std::vector<std::string> render(const std::string& samples) const {
        return {"render",    libraryScene("cornell_boxes.dae"),
                "-o",        folder.file("a.png"),
                "--backend", "reference",
                "-r",        "32",
                "24",        "-s",
                samples};
    }
};

TEST_F(OnTerminal, LinesAreCutToItsWidth) {
    RunningProgram program(render("10M"), {30});
    ASSERT_TRUE(program.says("left", kSoon));
    ASSERT_TRUE(program.says(kErase + "  ", kSoon));
    program.send(SIGTERM);
    std::istringstream drawn(program.finish(kSoon).err);
    size_t bars = 0;
    for (std::string line; std::getline(drawn, line, '\r');) {
        if (line.find(" left") == std::string::npos) continue;
        ++bars;
        EXPECT_LE(line.size(), std::string("\033[K").size() + 29) << line;
    }
    EXPECT_GT(bars, 0u);
}

TEST_F(OnTerminal, NothingIsDrawnInPlaceWhereThatIsNotPossibleOrNotWanted) {
    for (const Terminal& terminal : {Terminal{80, "dumb"}, Terminal{}}) {
        RunningProgram program(render("64"), terminal);
        const ProgramRun run = program.finish(kSoon);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_THAT(run.err, Not(HasSubstr("\033")));
    }
    std::vector<std::string> quiet = render("64");
    quiet.push_back("-q");
    RunningProgram program(quiet, {80});
    EXPECT_EQ(program.finish(kSoon).err, "");
}

TEST_F(OnTerminal, ColoursAreLeftOutWhereNobodyWantsThem) {
    std::vector<std::string> wrong = {"render", folder.file("none.dae"), "-o",
                                      folder.file("a.png")};
    const std::string colour = "\033[31m"; // spdlog's red, after its bold
    RunningProgram usual(wrong, {80}), plain(wrong, {80}, {"NO_COLOR=1"}),
        unset(wrong, {80}, {"NO_COLOR="});
    EXPECT_THAT(usual.finish(kSoon).err, HasSubstr(colour));
    EXPECT_THAT(unset.finish(kSoon).err, HasSubstr(colour));
    EXPECT_THAT(plain.finish(kSoon).err, Not(HasSubstr(colour)));
}

TEST(TimeLeft, IsForetoldFromWhatCameAfterTheFirstNews) {
    TimeLeft left;
    EXPECT_FALSE(left.after(13, 1e-6)); // thirteen seconds of compiling say nothing
    EXPECT_FALSE(left.after(14, 0.01)); // too soon
    EXPECT_FALSE(TimeLeft().after(1e9, 0.5));
    const auto foretold = left.after(17, 0.2 + 1e-6);
    ASSERT_TRUE(foretold);
    EXPECT_NEAR(*foretold, 4 * (0.8 - 1e-6) / 0.2, 1e-9);
    TimeLeft stuck;
    stuck.after(0, 0.5);
    EXPECT_FALSE(stuck.after(100, 0.5));
}

} // namespace
} // namespace stromboli::test
