// What `stromboli stress` says of what it found.
#include "host/stress/case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <set>

namespace stromboli::test {
namespace {

using stress::Finding;
using stress::Outcome;
using testing::HasSubstr;
using testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Outcome outcomeOf(const Finding& finding, const std::string& error = "") {
    return {{"walls", "15", "walls hold", "escapes", "rays", nullptr}, finding, error};
}

TEST(StressReport, AFindingPassesUpToItsBound) {
    EXPECT_TRUE((Finding{3, 3, 1, ""}.passed()));
    EXPECT_FALSE((Finding{3.01, 3, 1, ""}.passed()));
    EXPECT_FALSE((Finding{kNaN, 3, 1, ""}.passed())) << "what cannot be measured is no pass";
}

TEST(StressReport, TableSaysWhatWasWorstOfWhatFailed) {
    const std::string passed = stress::tableRow(outcomeOf({0, 0, 1000, "size 1"}));
    EXPECT_THAT(passed, HasSubstr("pass  walls"));
    EXPECT_THAT(passed, Not(HasSubstr("size 1")));
    const std::string failed = stress::tableRow(outcomeOf({7, 0, 1000, "size 1"}));
    EXPECT_THAT(failed, HasSubstr("FAIL  walls"));
    EXPECT_THAT(failed, HasSubstr("worst: size 1"));
    const std::string broken = stress::tableRow(outcomeOf({}, "the device was lost"));
    EXPECT_THAT(broken, HasSubstr("FAIL  walls"));
    EXPECT_THAT(broken, HasSubstr("the device was lost"));
}

TEST(StressReport, JsonHasTheVerdictOfAllAndNullForWhatIsNoNumber) {
    const stress::Circumstances circumstances{"a device", "a driver", "1.0", stress::Amount::Full};
    const auto json = nlohmann::json::parse(
        stress::toJson(circumstances, {outcomeOf({0, 0, 5, ""}), outcomeOf({kNaN, 0, 5, "there"})})
            .dump());
    EXPECT_FALSE(json["passed"]);
    EXPECT_TRUE(json["full"]);
    EXPECT_TRUE(json["cases"][0]["passed"]);
    EXPECT_TRUE(json["cases"][1]["measured"].is_null());
    EXPECT_EQ(json["cases"][1]["where"], "there");
    const auto lost =
        nlohmann::json::parse(stress::toJson(circumstances, {outcomeOf({}, "lost")}).dump());
    EXPECT_FALSE(lost["passed"]);
    EXPECT_EQ(lost["cases"][0]["error"], "lost");
}

TEST(StressReport, EveryCaseHasANameOfItsOwnAndSaysWhatItMeasures) {
    std::set<std::string> names;
    for (const stress::Case& c : stress::allCases()) {
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        for (const std::string& text : {c.name, c.numbers, c.property, c.measure, c.trial})
            EXPECT_NE(text, "") << c.name;
    }
}

} // namespace
} // namespace stromboli::test
