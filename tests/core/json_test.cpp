#include "host/core/json.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace stromboli::test {
namespace {

std::string problemOf(const std::string& text, int deepest) {
    try {
        parseJson(text, deepest);
    } catch (const JsonError& error) {
        return error.what();
    }
    return "";
}

TEST(ParseJson, TextFromElsewhereHasBounds) {
    EXPECT_EQ(parseJson(R"({"a": [1]})", 2).at("a").size(), 1u);
    EXPECT_EQ(problemOf("[[[]]]", 3), "");
    EXPECT_EQ(problemOf("[[[[]]]]", 3), "brackets go deeper than 3 levels");
    EXPECT_EQ(problemOf(std::string(1000000, '['), 3), "brackets go deeper than 3 levels");
    EXPECT_EQ(problemOf("{\n\n\"a\" 1}", 3), "its JSON is wrong in line 3");
    EXPECT_EQ(problemOf("1e999", 3), "its JSON has a number beyond the range of double");
}

TEST(ParseJson, MembersKeepTheirOrder) {
    EXPECT_EQ(parseJson(R"({"b": 1, "a": [2.5, null]})", 3).dump(), R"({"b":1,"a":[2.5,null]})");
}

TEST(ParseJson, TextThatIsNoJsonIsAnError) {
    for (const char* text : {"", "{", "{\"a\":}", "nul", "[1,]", "{} {}"})
        EXPECT_NE(problemOf(text, 9), "") << text;
    EXPECT_TRUE(parseJson("null", 1).is_null());
}

} // namespace
} // namespace stromboli::test
