#include "scene/build/report.hpp"

#include "host/core/error.hpp"
#include "source_dir.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

namespace stromboli::build {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

LoadReport linesOf(const Report& report) {
    LoadReport lines;
    report.writeTo(lines);
    return lines;
}

TEST(ReportTest, WhatIsForgivenNamesTheFirstPlaceAndIsCounted) {
    Report report;
    report.forgive({"a.xyz", 3, "thing"}, "'x' is there twice", "the first counts");
    report.forgive({"a.xyz", 9, "other"}, "'y' is there twice", "the first counts");
    report.forgive({"a.xyz", 0, ""}, "has no beginning", "it begins at 0");
    EXPECT_THAT(linesOf(report).forgiven,
                ElementsAre("a.xyz:3: <thing>: 'x' is there twice: the first counts (2 times)",
                            "a.xyz: has no beginning: it begins at 0"));
}

TEST(ReportTest, StrictForgivesNothing) {
    Report report(true);
    try {
        report.forgive({"a.xyz", 3, "thing"}, "is there twice", "the first counts");
        FAIL() << "forgiven";
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(),
                     "a.xyz:3: <thing>: is there twice (an error because of --strict)");
    }
    // All else is no matter of rules.
    report.ignore("<fog>", "not supported");
    report.warn("a polygon is left out");
    report.assume("a mesh is grey");
    const LoadReport lines = linesOf(report);
    EXPECT_THAT(lines.forgiven, IsEmpty());
    EXPECT_THAT(lines.assumed, ElementsAre("a mesh is grey"));
    EXPECT_EQ(lines.ignored.size() + lines.warnings.size(), 2u);
}

TEST(Shortfalls, AreTheTableForUsers) {
    std::ifstream file(std::string(STROMBOLI_SOURCE_DIR) + "/docs/guide/replacements.md");
    std::vector<std::string> rows;
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("| a") || line.starts_with("| c")) rows.push_back(line);
    ASSERT_EQ(rows.size(), kShortfalls.size());
    for (size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(rows[i], fmt::format("| {} | {} |", kShortfalls[i].what, kShortfalls[i].instead));
}

TEST(Shortfalls, AreForgivenOrErrorsByStrictness) {
    const FilePlace place{"a.xyz", 3, "picture"};
    Report forgiving, strict(true);
    forgiving.replace(place, Shortfall::Picture, "is not there");
    forgiving.replace(place, Shortfall::Picture, "is damaged");
    EXPECT_THAT(linesOf(forgiving).forgiven,
                ElementsAre("a.xyz:3: <picture>: is not there: there is no picture on the surface "
                            "(2 times)"));
    EXPECT_EQ(forgiving.firstError(), nullptr);
    EXPECT_THROW(strict.replace(place, Shortfall::Picture, "is not there"), SceneError);
    const SceneError error("a.xyz", 3, "mesh", "is wrong");
    forgiving.replace(error, Shortfall::Geometry);
    ASSERT_NE(forgiving.firstError(), nullptr);
    EXPECT_EQ(*forgiving.firstError(), error.what());
    EXPECT_THROW(strict.replace(error, Shortfall::Geometry), SceneError);
}

} // namespace
} // namespace stromboli::build
