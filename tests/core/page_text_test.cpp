// What stands in pages that the program writes.
#include "host/core/page_text.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

TEST(PageText, JsonInAScriptElementCannotLeaveIt) {
    EXPECT_EQ(forScript(R"({"a": "</script><!--<script>", "b": 1})"),
              R"({"a": "\u003c/script>\u003c!--\u003cscript>", "b": 1})");
}

TEST(PageText, MarksGiveWayToTexts) {
    const std::pair<std::string_view, std::string_view> marks[] = {
        {"@A@", "one"}, {"@B@", "@A@"}, {"@A@", ""}};
    EXPECT_EQ(filledIn("<p>@A@</p>@B@-@A@.", marks), "<p>one</p>@A@-.");
}

} // namespace
} // namespace stromboli::test
