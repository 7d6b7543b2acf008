// Plans as files: what comes back, damage, and how shares divide them.
#include "host/core/error.hpp"
#include "host/farm/round_plan.hpp"
#include "tests/farm/films.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

namespace stromboli {
namespace {

using namespace test;
using testing::HasSubstr;

/// The third round of a picture, in which two of three pixels get more samples.
RoundPlan smallPlan() {
    RoundPlan plan;
    plan.picture = pictureOf(16, 4);
    plan.picture.planned = {{0x12345678, 4711, 0, {}, {}}};
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
        plan.from.push_back(16 + i % 5);
        plan.to.push_back(i % 3 == 0 ? plan.from.back() : plan.from.back() + 1 + i % 7 * 8);
    }
    return plan;
}

std::string planRefusal(const std::filesystem::path& file) {
    return test::refusalOf([&] { readPlan(file); });
}

TEST(PlanFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    const RoundPlan plan = smallPlan();
    writePlan(folder / "a.plan", plan);
    const RoundPlan back = readPlan(folder / "a.plan");
    EXPECT_EQ(toBytes(back.picture), toBytes(plan.picture));
    EXPECT_EQ(back.from, plan.from);
    EXPECT_EQ(back.to, plan.to);
    EXPECT_EQ(back.round(), 3u);
    EXPECT_EQ(checksumOf(back), checksumOf(plan));
    EXPECT_EQ(folder.size(), 1u);
}

TEST(PlanFile, DamageIsSeen) {
    const TemporaryFolder folder;
    writePlan(folder / "a.plan", smallPlan());
    std::ifstream stream(folder / "a.plan", std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    for (size_t i = 0; i < whole.size(); i += i < 700 ? 1 : 17) {
        std::string damaged = whole;
        damaged[i] = char(damaged[i] ^ 0x10);
        std::ofstream(folder / "b.plan", std::ios::binary) << damaged;
        ASSERT_THAT(planRefusal(folder / "b.plan"), HasSubstr("/b.plan: ")) << "byte " << i;
    }
    for (size_t size = 0; size < whole.size(); size += 31) {
        std::ofstream(folder / "b.plan", std::ios::binary) << whole.substr(0, size);
        ASSERT_THAT(planRefusal(folder / "b.plan"), HasSubstr("/b.plan: ")) << size;
    }
}

TEST(PlanFile, SaysWhatIsNoPlan) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.plan") << "not a plan at all";
    EXPECT_THAT(planRefusal(folder / "a.plan"), HasSubstr("not a plan of this version"));
    EXPECT_THAT(planRefusal(folder / "none.plan"), HasSubstr("there is no such plan"));
    EXPECT_THAT(planRefusal(folder.path()), HasSubstr("cannot read the plan"));
}

TEST(PlanFile, RefusesWhatMakesNoSense) {
    const TemporaryFolder folder;
    const auto refusal = [&](const std::function<void(RoundPlan&)>& change) {
        RoundPlan plan = smallPlan();
        change(plan);
        writePlan(folder / "a.plan", plan);
        return planRefusal(folder / "a.plan");
    };
    EXPECT_EQ(refusal([](RoundPlan&) {}), "");
    EXPECT_THAT(refusal([](RoundPlan& p) { p.to[7] = p.from[7] - 1; }), HasSubstr("no sense"));
    EXPECT_THAT(refusal([](RoundPlan& p) { p.to[7] = kMostSamples + 1; }), HasSubstr("no sense"));
    EXPECT_THAT(refusal([](RoundPlan& p) { p.to = p.from; }), HasSubstr("no sense"));
    EXPECT_THAT(refusal([](RoundPlan& p) { p.to.pop_back(); }), HasSubstr("damaged"));
    EXPECT_THAT(refusal([](RoundPlan& p) { p.picture.planned[0].samples = 0; }),
                HasSubstr("no sense"));
}

/// Every sample is in a share, whatever the number of shares: each once, and about as many in each
/// share.
TEST(RoundPlan, SharesAreAllOfItOnce) {
    const RoundPlan plan = smallPlan();
    for (const uint32_t shares : {1u, 2u, 7u, 64u, 100'000u}) {
        std::vector<uint32_t> times(plan.from.size(), 0);
        uint64_t held = 0, most = 0;
        uint32_t place = 0;
        for (uint32_t i = 1; i <= shares; i += shares > 1000 && i < 99'000 ? 997 : 1) {
            const PlannedShare share = ofShare(plan, {i, shares});
            uint64_t samples = 0;
            for (const PlannedPixel& p : share.pixels) {
                EXPECT_EQ(p.from, plan.from[p.pixel]);
                EXPECT_EQ(p.to, plan.to[p.pixel]);
                samples += p.to - p.from;
                ++times[p.pixel];
            }
            const PlannedRound& round = share.header.planned.back();
            EXPECT_EQ(share.header.rounds(), 3u);
            EXPECT_EQ(round.plan, checksumOf(plan));
            EXPECT_EQ(round.samples, plan.samples());
            EXPECT_EQ(round.held, samples);
            if (shares <= 1000 && !round.places.empty()) {
                EXPECT_EQ(round.places.front().first, place);
                place = round.places.front().end;
            }
            held += samples;
            most = std::max(most, samples);
        }
        if (shares > 1000) continue; // some of them
        EXPECT_EQ(held, plan.samples());
        EXPECT_LE(most, plan.samples() / shares + 1 + 48); // a pixel more, at most
        for (size_t i = 0; i < times.size(); ++i)
            ASSERT_EQ(times[i], plan.to[i] > plan.from[i]) << i;
    }
}

/// Pixels side by side are in one share mostly, and far ones in all: a share is no strip.
TEST(RoundPlan, SharesLieAllOverThePicture) {
    RoundPlan plan;
    plan.picture = pictureOf(16, 4);
    plan.picture.settings.area = {320, 240, {}};
    plan.from.assign(320 * 240, 16);
    plan.to.assign(320 * 240, 24);
    for (uint32_t i = 1; i <= 4; ++i) {
        double x = 0, y = 0;
        const PlannedShare share = ofShare(plan, {i, 4});
        for (const PlannedPixel& p : share.pixels)
            x += p.pixel % 320, y += p.pixel / 320;
        // Means of 300 tiles: their sigma is 1/60 of the picture's side.
        EXPECT_NEAR(x / double(share.pixels.size()) / 320, 0.5, 0.07);
        EXPECT_NEAR(y / double(share.pixels.size()) / 240, 0.5, 0.07);
    }
}

} // namespace
} // namespace stromboli
