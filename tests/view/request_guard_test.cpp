// Who may ask a server, request by request.
#include "host/view/request_guard.hpp"

#include <gtest/gtest.h>

#include <set>

namespace stromboli::view {
namespace {

const GuardRules kAtHome{{"127.0.0.1:80", "localhost:80", "[::1]:80"}, "secret", false};
const GuardRules kAbroad{{}, "secret", true};

RequestFacts fine() {
    RequestFacts facts;
    facts.method = "GET";
    facts.path = "/frame";
    facts.host = "127.0.0.1:80";
    facts.token = "secret";
    facts.targetLength = 30;
    facts.headerCount = 10;
    return facts;
}

int statusOf(const RequestFacts& facts, const GuardRules& rules = kAtHome) {
    const auto refusal = refusalOf(facts, rules);
    return refusal ? refusal->status : 200;
}

/// The status of a request in which `change` has changed something.
template <class Change>
int statusWith(const Change& change, const GuardRules& rules = kAtHome) {
    RequestFacts facts = fine();
    change(facts);
    return statusOf(facts, rules);
}

TEST(RequestGuard, LetsItsOwnPageAsk) {
    EXPECT_EQ(statusOf(fine()), 200);
    EXPECT_EQ(statusWith([](auto& f) { f.origin = "http://127.0.0.1:80"; }), 200);
    EXPECT_EQ(statusWith([](auto& f) { f.site = "same-origin"; }), 200);
    EXPECT_EQ(statusWith([](auto& f) { f.host = "localhost:80"; }), 200);
    EXPECT_EQ(statusWith([](auto& f) { f.host = "[::1]:80"; }), 200);
    EXPECT_EQ(statusWith([](auto& f) { f.method = "POST"; }), 200);
}

TEST(RequestGuard, RefusesOtherNames) {
    for (const char* host : {"", "evil.example", "evil.example:80", "127.0.0.1", "127.0.0.1:81",
                             "127.0.0.1:80.evil.example", "localhost", "LOCALHOST:80 "})
        EXPECT_EQ(statusWith([&](auto& f) { f.host = host; }), 403) << host;
}

TEST(RequestGuard, RefusesPagesOfOthers) {
    for (const char* origin : {"null", "http://evil.example", "https://127.0.0.1:80",
                               "http://localhost:80", "http://127.0.0.1:81"})
        EXPECT_EQ(statusWith([&](auto& f) { f.origin = origin; }), 403) << origin;
    for (const char* site : {"cross-site", "same-site", "other"})
        EXPECT_EQ(statusWith([&](auto& f) { f.site = site; }), 403) << site;
}

TEST(RequestGuard, WantsTheTokenForAllButThePage) {
    for (const char* token : {"", "secre", "secret1", "Secret"}) {
        const auto has = [&](auto& f) { f.token = token; };
        EXPECT_EQ(statusWith(has), 403) << token;
        const auto page = [&](auto& f) { f.token = token, f.path = "/"; };
        EXPECT_EQ(statusWith(page), 200);
        EXPECT_EQ(statusWith([&](auto& f) { page(f), f.method = "POST"; }), 403);
    }
}

TEST(RequestGuard, AbroadWantsTheTokenForThePageTooAndKnowsAnyName) {
    EXPECT_EQ(statusWith([](auto& f) { f.host = "render.example:8080"; }, kAbroad), 200);
    EXPECT_EQ(statusWith([](auto& f) { f.host = ""; }, kAbroad), 403);
    EXPECT_EQ(statusWith([](auto& f) { f.path = "/", f.token = ""; }, kAbroad), 403);
    EXPECT_EQ(statusWith([](auto& f) { f.path = "/"; }, kAbroad), 200);
    EXPECT_EQ(statusWith([](auto& f) { f.host = "a:1", f.origin = "http://b:1"; }, kAbroad), 403);
}

TEST(RequestGuard, RefusesWhatIsLargeOrUnknown) {
    for (const char* method : {"PUT", "DELETE", "OPTIONS", "HEAD", "PATCH", "TRACE", "get", ""})
        EXPECT_EQ(statusWith([&](auto& f) { f.method = method; }), 405) << method;
    EXPECT_EQ(statusWith([](auto& f) { f.hasBody = true; }), 413);
    EXPECT_EQ(statusWith([](auto& f) { f.targetLength = 2049; }), 414);
    EXPECT_EQ(statusWith([](auto& f) { f.headerCount = 65; }), 431);
}

TEST(RequestGuard, TokensAreLongAndDiffer) {
    std::set<std::string> tokens;
    for (int i = 0; i < 100; ++i) {
        tokens.insert(randomToken());
        EXPECT_EQ(tokens.begin()->size(), 32u);
    }
    EXPECT_EQ(tokens.size(), 100u);
}

} // namespace
} // namespace stromboli::view
