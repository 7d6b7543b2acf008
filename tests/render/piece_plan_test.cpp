// How a pass is shared by backends of different speeds: simulated, by a clock of its own.
#include "host/render/team_backend.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace stromboli {
namespace {

constexpr double kLeast = 0.1;

struct Simulated {
    std::vector<double> ends;      ///< when each member has nothing to do any more
    std::vector<double> lastPiece; ///< how long the last one of each took
    uint64_t samples = 0;
    size_t pieces = 0;
};

/// Passes of so many samples, one after the other; `speeds` in samples per second. jitter: how much
/// longer or shorter a piece may take than by its samples.
Simulated simulate(PiecePlan& plan, const std::vector<double>& speeds, uint64_t samples,
                   double jitter = 0) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> factor(1 - jitter, 1 + jitter);
    Simulated s{std::vector<double>(speeds.size()), std::vector<double>(speeds.size()), 0, 0};
    std::vector<bool> isDone(speeds.size());
    struct Hand {
        uint64_t samples = 0;
        double seconds = 0;
    };
    std::vector<Hand> hands(speeds.size());
    uint64_t left = samples;
    for (;;) {
        size_t next = speeds.size(); // the member that is the first to have nothing to do
        for (size_t m = 0; m < speeds.size(); ++m)
            if (!isDone[m] && (next == speeds.size() || s.ends[m] < s.ends[next])) next = m;
        if (next == speeds.size()) return s;
        if (hands[next].samples > 0) plan.took(next, hands[next].samples, hands[next].seconds);
        hands[next] = {};
        if (left == 0) {
            isDone[next] = true;
            continue;
        }
        const uint64_t piece = plan.next(next, left);
        left -= piece;
        s.samples += piece;
        ++s.pieces;
        hands[next] = {piece, double(piece) / speeds[next] * factor(random)};
        s.lastPiece[next] = hands[next].seconds;
        s.ends[next] += hands[next].seconds;
    }
}

double waitOf(const Simulated& s) {
    const auto [first, last] = std::ranges::minmax(s.ends);
    return last - first;
}

double sum(const std::vector<double>& speeds) {
    double all = 0;
    for (const double speed : speeds)
        all += speed;
    return all;
}

const std::vector<std::vector<double>> kTeams = {
    {1e6, 1e6}, {1e6, 2e7}, {3e6, 1e8, 9e7, 1e6}, {1e6, 1e8}, {5e6}};

TEST(PiecePlan, AllEndWithinTheLeastPiece) {
    for (const std::vector<double>& speeds : kTeams) {
        PiecePlan plan(speeds.size(), kLeast);
        const auto samples = uint64_t(sum(speeds) * 20); // 20 s if nobody waits
        const Simulated s = simulate(plan, speeds, samples);
        EXPECT_EQ(s.samples, samples);
        EXPECT_LE(waitOf(s), kLeast * 1.0001) << speeds.size();
        EXPECT_LE(*std::ranges::max_element(s.ends), 20 + kLeast);
        EXPECT_LE(s.pieces, 200u * speeds.size()) << "pieces are needlessly small";
    }
}

/// Where pieces take up to 30 % more or less than they should, a member waits for the least piece
/// of a slower one at most.
TEST(PiecePlan, AllEndTogetherWherePixelsDiffer) {
    for (const std::vector<double>& speeds : kTeams) {
        PiecePlan plan(speeds.size(), kLeast);
        const Simulated s = simulate(plan, speeds, uint64_t(sum(speeds) * 20), 0.3);
        // A speed is wrong by 1.3 / 0.7, and the piece itself by 1.3.
        EXPECT_LE(waitOf(s), kLeast * 1.3 * 1.3 / 0.7);
    }
}

/// Later passes know the speeds from the beginning, however short they are.
TEST(PiecePlan, ShortPassesAfterALongOne) {
    const std::vector<double> speeds = {1e5, 1e7};
    PiecePlan plan(2, kLeast);
    simulate(plan, speeds, uint64_t(1e8));
    for (const double seconds : {0.01, 0.1, 1.0}) {
        const Simulated s = simulate(plan, speeds, uint64_t(sum(speeds) * seconds));
        EXPECT_LE(waitOf(s), kLeast * 1.0001) << seconds;
    }
}

TEST(PiecePlan, TheFirstPieceIsSmall) {
    EXPECT_EQ(PiecePlan(2, kLeast).next(0, 512 * 1000), 1000u);
    EXPECT_EQ(PiecePlan(2, kLeast).next(1, 1), 1u);
}

/// At an equal speed, half of half for each of two and half of all for the one that is left.
TEST(PiecePlan, WhoDropsOutLeavesItsShareToTheOthers) {
    PiecePlan plan(2, kLeast);
    for (int i = 0; i < 50; ++i)
        for (const size_t m : {0, 1})
            plan.took(m, 1'000'000, 1);
    EXPECT_NEAR(double(plan.next(0, 8'000'000)), 2e6, 1);
    plan.dropOut(1);
    EXPECT_NEAR(double(plan.next(0, 8'000'000)), 4e6, 1);
}

} // namespace
} // namespace stromboli
