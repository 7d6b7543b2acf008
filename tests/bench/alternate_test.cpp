// How measurements are taken: their order and what is made of them, never how long anything took.
#include "host/bench/measuring.hpp"

#include <gtest/gtest.h>

namespace stromboli::bench {
namespace {

AlternatePlan plan(uint32_t repeats) {
    AlternatePlan p;
    p.repeats = repeats;
    p.leastSeconds = 0;
    return p;
}

TEST(Alternate, EachOnceUnmeasuredThenInTurn) {
    std::string order;
    const auto contestant = [&](char name) {
        return Contestant{std::string(1, name), [&order, name] {
                              order += name;
                              return Work{};
                          }};
    };
    const std::vector<Series> all =
        alternate({contestant('A'), contestant('B'), contestant('C')}, plan(2));
    EXPECT_EQ(order, "ABC"      // unmeasured
                     "ABCABC"); // not AABBCC: a change of clock rate would meet one of them alone
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[1].name, "B");
    EXPECT_EQ(all[1].wallSeconds.size(), 2u);
    EXPECT_EQ(all[1].cpuSeconds.size(), 2u);
}

TEST(Alternate, DeviceSecondsAreForOneItem) {
    const std::vector<Series> all = alternate({{"with a clock",
                                                [] {
                                                    return Work{4, 10};
                                                }},
                                               {"without",
                                                [] {
                                                    return Work{4, 0};
                                                }}},
                                              plan(3));
    EXPECT_EQ(all[0].deviceSeconds, (std::vector<double>{2.5, 2.5, 2.5}));
    EXPECT_TRUE(all[1].deviceSeconds.empty());
}

TEST(Alternate, AMeasurementRepeatsShortWork) {
    AlternatePlan p = plan(1);
    p.leastSeconds = 0.01;
    int runs = 0;
    alternate({{"short",
                [&] {
                    ++runs;
                    return Work{};
                }}},
              p);
    EXPECT_GT(runs, 2);
}

TEST(Alternate, ProgressMayStopIt) {
    int runs = 0;
    AlternatePlan p = plan(100);
    p.progress = [&](const std::string&) {
        if (runs == 3) throw Stopped();
    };
    EXPECT_THROW(alternate({{"endless",
                             [&] {
                                 ++runs;
                                 return Work{};
                             }}},
                           p),
                 Stopped);
    EXPECT_EQ(runs, 3);
}

/// The machine halves its speed from the second round on. Ratios within rounds do not mind; the
/// ratio of medians of all would be off.
TEST(Speedup, IsOfRoundsNotOfMedians) {
    const std::vector<double> ours = {1, 2, 2}, theirs = {3, 6, 6};
    const Spread s = speedup(ours, theirs);
    EXPECT_EQ(s.least, 3);
    EXPECT_EQ(s.most, 3);
    const std::vector<double> late = {1, 1, 2}, early = {3, 3, 6};
    EXPECT_EQ(speedup(late, early).median, 3);
    EXPECT_NE(spreadOf(theirs).median / spreadOf(late).median, 3);
}

TEST(Series, RatesAreOfWallTimeAndThreadsOfCpuTime) {
    Series s;
    s.wallSeconds = {0.5, 0.25};
    s.cpuSeconds = {1.0, 0.5};
    EXPECT_EQ(s.wallRate().least, 2);
    EXPECT_EQ(s.wallRate().most, 4);
    EXPECT_EQ(s.parallelism(), 2);
}

} // namespace
} // namespace stromboli::bench
