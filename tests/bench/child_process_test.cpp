#include "host/bench/startup_bench.hpp"
#include "host/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace stromboli::bench {
namespace {

TEST(ChildProcess, HasTheEnvironmentWithChanges) {
    setenv("STROMBOLI_TEST_KEPT", "kept", 1);
    setenv("STROMBOLI_TEST_CHANGED", "old", 1);
    const std::string out =
        runProgram({"/bin/sh", "-c", "echo $STROMBOLI_TEST_KEPT $STROMBOLI_TEST_CHANGED"},
                   {{"STROMBOLI_TEST_CHANGED", "new"}});
    EXPECT_EQ(out, "kept new\n");
}

TEST(ChildProcess, FailuresSayWhatTheProgramSaidLast) {
    try {
        runProgram({"/bin/sh", "-c", "echo first >&2; echo last words >&2; exit 3"}, {});
        FAIL() << "no exception";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("last words"));
        EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("first\n")));
    }
    EXPECT_THROW(runProgram({"/no/such/program"}, {}), DeviceError);
}

TEST(ScratchFolder, GoesWithWhatIsInIt) {
    std::filesystem::path path;
    {
        const ScratchFolder folder;
        path = folder.path();
        std::ofstream(path / "file") << "text";
        EXPECT_TRUE(std::filesystem::exists(path / "file"));
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(StartupStages, SurviveBeingText) {
    const StartupReport::Stages stages = {0.1, 0.25, 1e-9, 3, 0, 1.0 / 3};
    const StartupReport::Stages back = stagesFrom(toText(stages));
    EXPECT_EQ(back.device, 0.1);
    EXPECT_EQ(back.load, 0.25);
    EXPECT_EQ(back.build, 1e-9);
    EXPECT_EQ(back.pipeline, 3);
    EXPECT_EQ(back.firstDispatch, 0);
    EXPECT_EQ(back.secondDispatch, 1.0 / 3);
    EXPECT_THROW(stagesFrom("0.1 0.2"), DeviceError);
}

} // namespace
} // namespace stromboli::bench
