#include "scene/build/report.hpp"

#include "host/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

} // namespace
} // namespace stromboli::build
