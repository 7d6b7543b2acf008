#include "host/core/json.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <sstream>

namespace stromboli::test {
namespace {

std::optional<Json> parsed(const std::string& text) {
    std::istringstream in(text);
    return Json::parse(in);
}

TEST(JsonValue, ListsOfNamesAndValuesAreObjectsInTheirOrder) {
    const Json json = {
        {"b", 1}, {"a", "x"}, {"list", {1, 2.5, true, nullptr}}, {"in", {{"c", -3}}}};
    EXPECT_EQ(json.dump(), R"({"b":1,"a":"x","list":[1,2.5,true,null],"in":{"c":-3}})");
    EXPECT_EQ(Json::array().dump(), "[]");
    EXPECT_EQ(Json::object().dump(), "{}");
    const Json lines = {{"a", 1}};
    EXPECT_EQ(lines.dump(2), "{\n  \"a\": 1\n}");
}

TEST(JsonValue, ContainersAreArrays) {
    EXPECT_EQ(Json(std::vector<std::string>{"a", "b"}).dump(), R"(["a","b"])");
    EXPECT_EQ(Json(std::array<double, 2>{0.5, 1}).dump(), "[0.5,1.0]");
    EXPECT_EQ(Json(std::vector<double>{}).dump(), "[]");
    EXPECT_EQ(Json(std::map<std::string, int>{{"b", 1}, {"a", 2}}).dump(), R"({"a":2,"b":1})");
    EXPECT_EQ(Json(std::string("text")).dump(), "\"text\"");
}

TEST(JsonValue, NumbersSurviveReadingAndWriting) {
    const Json numbers = {std::numeric_limits<uint64_t>::max(), std::numeric_limits<int64_t>::min(),
                          0.1, 1e300, 5e-324};
    const std::optional<Json> read = parsed(numbers.dump());
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, numbers);
    EXPECT_EQ(read->elements()[0].get<uint64_t>(), std::numeric_limits<uint64_t>::max());
    EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).dump(), "null");
}

std::string problemOf(const std::string& text, int deepest) {
    try {
        Json::parse(text, deepest);
    } catch (const JsonError& error) {
        return error.what();
    }
    return "";
}

TEST(JsonValue, TextFromElsewhereHasBounds) {
    EXPECT_EQ(Json::parse(R"({"a": [1]})", 2).at("a").elements().size(), 1u);
    EXPECT_EQ(problemOf("[[[]]]", 3), "");
    EXPECT_EQ(problemOf("[[[[]]]]", 3), "brackets go deeper than 3 levels");
    EXPECT_EQ(problemOf(std::string(1000000, '['), 3), "brackets go deeper than 3 levels");
    EXPECT_EQ(problemOf("{\n\n\"a\" 1}", 3), "its JSON is wrong in line 3");
    EXPECT_EQ(problemOf("1e999", 3), "its JSON has a number beyond the range of double");
}

TEST(JsonValue, MembersAreFoundAddedAndRemoved) {
    Json json = {{"a", 1}};
    json["b"]["c"] = "deep";
    json["a"] = 2;
    EXPECT_EQ(json.dump(), R"({"a":2,"b":{"c":"deep"}})");
    EXPECT_EQ(json.at("b").at("c").get<std::string>(), "deep");
    EXPECT_EQ(json.value("a", 0u), 2u);
    EXPECT_EQ(json.value("none", 7u), 7u);
    json.erase("a");
    json.erase("none");
    EXPECT_EQ(json.dump(), R"({"b":{"c":"deep"}})");
}

TEST(JsonValue, WhatIsNotExpectedIsAnError) {
    Json json = {{"a", 1}, {"list", {1}}};
    EXPECT_THROW(json.at("none"), JsonError);
    EXPECT_THROW(json.at("a").at("b"), JsonError);
    EXPECT_THROW(json.at("a").get<std::string>(), JsonError);
    EXPECT_THROW(json.at("a").get<bool>(), JsonError);
    EXPECT_THROW(json.at("list").get<double>(), JsonError);
    EXPECT_THROW(json.at("a").elements(), JsonError);
    EXPECT_THROW(json["a"]["b"], JsonError);
    EXPECT_THROW(json.push_back(1), JsonError);
}

TEST(JsonValue, TextThatIsNoJsonIsNothing) {
    for (const char* text : {"", "{", "{\"a\":}", "nul", "[1,]", "{} {}"})
        EXPECT_FALSE(parsed(text)) << text;
    EXPECT_TRUE(parsed("null")->isNull());
    EXPECT_TRUE(parsed(" {\"a\": [true, -1, \"x\\u00e4\"]} ")->isObject());
}

} // namespace
} // namespace stromboli::test
