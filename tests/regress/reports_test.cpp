// Reports of a suite: what tools and people read of one that passes, fails or was stopped.
#include "host/regress/reports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tinyxml2.h>

namespace stromboli::regress {
namespace {

using testing::HasSubstr;
using testing::Not;

Results resultsOf(const std::vector<Verdict>& verdicts) {
    Results r;
    r.suite.file = "some/suite.toml";
    for (const Verdict verdict : verdicts) {
        Outcome& o = r.outcomes.emplace_back();
        o.which.name = "picture " + std::to_string(r.outcomes.size());
        o.verdict = verdict;
        if (verdict != Verdict::Agrees && verdict != Verdict::Updated)
            o.reasons = {"a reason with <, & and \"quotes\"", "another </script>"};
    }
    return r;
}

TEST(RegressReports, OnlyAgreementPasses) {
    EXPECT_TRUE(resultsOf({Verdict::Agrees, Verdict::Updated}).passed());
    for (const Verdict v : {Verdict::Differs, Verdict::NoGolden, Verdict::Failed}) {
        EXPECT_FALSE(resultsOf({Verdict::Agrees, v}).passed());
        EXPECT_TRUE(resultsOf({Verdict::Agrees, v}).failed());
    }
    EXPECT_FALSE(resultsOf({Verdict::Undecided}).passed());
    EXPECT_FALSE(resultsOf({Verdict::Undecided, Verdict::NotRun}).failed());
}

TEST(RegressReports, JUnitSaysWhatFailed) {
    const std::string text =
        toJunit(resultsOf({Verdict::Agrees, Verdict::Differs, Verdict::NoGolden, Verdict::Failed,
                           Verdict::Undecided, Verdict::NotRun}));
    tinyxml2::XMLDocument document;
    ASSERT_EQ(document.Parse(text.c_str()), tinyxml2::XML_SUCCESS) << text;
    const tinyxml2::XMLElement* const suite = document.RootElement();
    EXPECT_STREQ(suite->Attribute("name"), "suite");
    EXPECT_EQ(suite->IntAttribute("tests"), 6);
    EXPECT_EQ(suite->IntAttribute("failures"), 2);
    EXPECT_EQ(suite->IntAttribute("errors"), 1);
    EXPECT_EQ(suite->IntAttribute("skipped"), 2);
    const tinyxml2::XMLElement* one = suite->FirstChildElement("testcase");
    EXPECT_STREQ(one->Attribute("name"), "picture 1");
    EXPECT_EQ(one->FirstChildElement("failure"), nullptr);
    one = one->NextSiblingElement("testcase");
    ASSERT_NE(one->FirstChildElement("failure"), nullptr);
    EXPECT_STREQ(one->FirstChildElement("failure")->Attribute("message"),
                 "a reason with <, & and \"quotes\"");
}

TEST(RegressReports, TextAndJsonNameEveryPicture) {
    const Results r = resultsOf({Verdict::Agrees, Verdict::Differs});
    EXPECT_THAT(toText(r), HasSubstr("FAIL: 1 of 2 pictures agree"));
    EXPECT_THAT(toText(r), HasSubstr("another </script>"));
    const Json json = toJson(r);
    EXPECT_FALSE(json["passed"]);
    ASSERT_EQ(json["pictures"].size(), 2u);
    EXPECT_EQ(json["pictures"][1]["verdict"], "differs");
    EXPECT_EQ(json["pictures"][1]["reasons"].size(), 2u);
}

TEST(RegressReports, NoTextEndsThePagesScript) {
    const std::string page = toPage(resultsOf({Verdict::Differs}), "/nowhere");
    EXPECT_THAT(page, HasSubstr("another \\u003c/script>"));
    EXPECT_THAT(page, Not(HasSubstr("@@")));
}

} // namespace
} // namespace stromboli::regress
