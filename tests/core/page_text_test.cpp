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

TEST(PageText, Base64OfRfc4648) {
    const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                           {"f", "Zg=="},
                                                           {"fo", "Zm8="},
                                                           {"foo", "Zm9v"},
                                                           {"foob", "Zm9vYg=="},
                                                           {"fooba", "Zm9vYmE="},
                                                           {"foobar", "Zm9vYmFy"}};
    for (const auto& [bytes, text] : vectors)
        EXPECT_EQ(toBase64(bytes), text);
    EXPECT_EQ(toBase64("\xFB\xFF"), "+/8=");
}

} // namespace
} // namespace stromboli::test
