// `stromboli stress` as a user meets it. What the cases find: tests/hard_cases.
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(StressCommand, ListsItsCasesWithoutADevice) {
    const ProgramRun run = stromboli({"stress", "--list"}, "VK_DRIVER_FILES=/none");
    EXPECT_EQ(run.exitCode, 0) << run.err;
    for (const char* name : {"edges", "escapes", "furnaces", "many-samples", "agreement"})
        EXPECT_THAT(run.out, HasSubstr(name));
}

TEST(StressCommand, UnknownCasesAreNamedBeforeTheWork) {
    for (const char* name : {"no-such-case", "99", "edge"}) {
        const ProgramRun run = stromboli({"stress", "edges", name}, "VK_DRIVER_FILES=/none");
        EXPECT_EQ(run.exitCode, kUsage) << name;
        EXPECT_THAT(run.err, HasSubstr("no case '" + std::string(name) + "'"));
        EXPECT_EQ(run.out, "");
    }
}

TEST(StressCommand, AnUnwritableReportIsFoundBeforeTheWork) {
    const ScratchFolder folder;
    const ProgramRun run = stromboli({"stress", "--json", folder.file("missing/stress.json")});
    EXPECT_EQ(run.exitCode, kOutput);
    EXPECT_EQ(run.out, "");
}

/// Chosen by name and by number, in the order of the list; nothing on standard error in a pipe.
TEST(StressCommand, ReportsOnTheTerminalAndAsJson) {
    const ScratchFolder folder;
    const ProgramRun run =
        stromboli({"stress", "tiny-triangles", "4", "--json", folder.file("stress.json")});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(run.err, "");
    for (const char* text : {"pass  integer-grid", "pass  tiny-triangles", "PASS: 2 of 2 cases"})
        EXPECT_THAT(run.out, HasSubstr(text));
    EXPECT_THAT(run.out, Not(HasSubstr("corners  ")));
    const auto json = nlohmann::json::parse(std::ifstream(folder.file("stress.json")));
    EXPECT_TRUE(json["passed"]);
    EXPECT_FALSE(json["full"]);
    EXPECT_NE(json["device"], "");
    ASSERT_EQ(json["cases"].size(), 2u);
    EXPECT_EQ(json["cases"][0]["name"], "integer-grid");
    EXPECT_EQ(json["cases"][0]["measured"], 0);
    EXPECT_GT(json["cases"][0]["trials"], 1000);
}

} // namespace
} // namespace stromboli::test
