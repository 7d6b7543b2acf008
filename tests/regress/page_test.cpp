// The report of a suite in a headless browser: what stands on it, and what flickers.
#include "host/film/image_formats.hpp"
#include "host/regress/reports.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/study/browser.hpp"

#include <gtest/gtest.h>

namespace stromboli::regress {
namespace {

constexpr const char* kDriver = R"js(
const seen = document.documentElement.dataset;
seen.verdict = document.getElementById('verdict').textContent;
seen.heads = [...document.querySelectorAll('h2')].map(h => h.textContent).join('|');
seen.images = document.querySelectorAll('img').length;
document.getElementById('all').click();
seen.allHeads = document.querySelectorAll('h2').length;
seen.reason = document.querySelector('li').textContent;
)js";

TEST(RegressPage, ShowsWhatFailedAndAllOnRequest) {
    if (!study::hasBrowser()) GTEST_SKIP() << "no chromium";
    const TemporaryFolder folder;
    Results r;
    r.suite.file = "suite.toml";
    Outcome& good = r.outcomes.emplace_back();
    good.which.name = "good";
    good.verdict = Verdict::Agrees;
    Outcome& bad = r.outcomes.emplace_back();
    bad.which.name = "bad";
    const compare::Picture golden(4, 3);
    compare::Picture picture(4, 3);
    picture.rgb[5] = glm::dvec3(1);
    judge(golden, picture, 0.01, bad);
    ASSERT_EQ(bad.verdict, Verdict::Differs);
    bad.reasons = {"<script>alert(1)</script>"};
    writePictures(folder.path(), golden, picture, bad);
    const std::string document =
        study::loadPage(folder.path(), toPage(r, folder.path()), kDriver, false);
    const auto seen = [&](const char* name) {
        return study::attributeOf(document, std::string("data-") + name);
    };
    EXPECT_EQ(seen("error"), "");
    EXPECT_EQ(seen("verdict"), "Not passed: suite.toml");
    EXPECT_EQ(seen("heads"), "bad: differs");
    EXPECT_EQ(seen("images"), "4");
    EXPECT_EQ(seen("all-heads"), "2");
    EXPECT_EQ(seen("reason"), "<script>alert(1)</script>");
}

} // namespace
} // namespace stromboli::regress
